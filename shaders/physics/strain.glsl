// Deformation of sand as the left stretch V (F = V R): the stress needs nothing else (NUMERICS 1, 2.6, 2.7; paper 3.3.2,
// 4.2.2; Drucker-Prager return mapping after Klar et al. 2016, cohesion after Tampubolon et al. 2017).
// Stored and passed as V - I, so that small strains keep their digits in float and dry cells hold zeros.
#ifndef PHYSICS_STRAIN
#define PHYSICS_STRAIN
#include "../physics/scalar.glsl"

struct Stretch {
    float xx, xy, yy; // V - I
};
struct Stress {
    float xx, xy, yy; // Cauchy stress [Pa]
};
struct Gradient {
    float xx, xy, yx, yy; // dts grad v: xy = d(vx)/dy
};

// artanh(x)/x from x^2 <= tanh(1/2)^2, relative error below 1e-7.
FN float arc_tanh_over(float t) {
    return 1.0f + t * (0.333334923f + t * (0.199896812f + t * (0.144998029f + t * (0.0921641961f + t * 0.162671462f))));
}

// e^x - 1 for |x| <= 0.5: Taylor series to the ninth power, relative error below 1e-7.
FN float exp_minus_one(float x) {
    float p = 2.48015873e-5f + x * 2.75573192e-6f;
    p = 1.98412698e-4f + x * p;
    p = 1.38888889e-3f + x * p;
    p = 8.33333333e-3f + x * p;
    p = 4.16666667e-2f + x * p;
    p = 1.66666667e-1f + x * p;
    p = 0.5f + x * p;
    return x + x * x * p;
}

// cosh(h) - 1 and sinh(h)/h from h^2 <= 0.25.
FN float cosh_minus_one(float hh) {
    return hh * (0.5f + hh * (4.16666667e-2f + hh * (1.38888889e-3f + hh * 2.48015873e-5f)));
}
FN float sinh_over(float hh) {
    return 1.0f + hh * (1.66666667e-1f + hh * (8.33333333e-3f + hh * (1.98412698e-4f + hh * 2.75573192e-6f)));
}

// One-sided at the rim of the sand (NUMERICS 2.6): dry neighbours say nothing about the velocity gradient. half_k: k/2 for twice the
// velocities.
FN float across_gradient(float low, float centre, float high, bool wet_low, bool wet_high, float half_k, float other) {
    float both_sides = 0.5f * (high - low);
    float one = wet_high ? high - centre : centre - low;
    float gradient = half_k * (both(wet_low, wet_high) ? both_sides : one);
    return either(wet_low, wet_high) ? gradient : -other;
}

// dts grad v of a cell: velocities of its four faces, twice the mean velocities of the cells around along the other axis.
FN Gradient velocity_gradient(float u_w, float u_e, float v_s, float v_n, float u_s, float u_n, float v_w, float v_e, bool wet_w, bool wet_e, bool wet_s,
                              bool wet_n, float k, float limit) {
    float u_c = u_w + u_e;
    float v_c = v_s + v_n;
    float half_k = 0.5f * k;
    bool any_y = either(wet_s, wet_n);
    bool any_x = either(wet_w, wet_e);
    float yx_alone = across_gradient(v_w, v_c, v_e, wet_w, wet_e, half_k, 0.0f);
    float xy = across_gradient(u_s, u_c, u_n, wet_s, wet_n, half_k, any_x ? yx_alone : 0.0f);
    float yx = any_x ? yx_alone : -(any_y ? xy : 0.0f);
    Gradient g;
    g.xx = wclamp(k * (u_e - u_w), -limit, limit);
    g.yy = wclamp(k * (v_n - v_s), -limit, limit);
    g.xy = wclamp(xy, -limit, limit);
    g.yx = wclamp(yx, -limit, limit);
    return g;
}

// Evolution by the Cayley form (I - G/2)^-1 (I + G/2), which rotates without stretching, then back to the left stretch.
FN Stretch evolve_stretch(Stretch v, Gradient g) {
    float ax = 1.0f - 0.5f * g.xx;
    float ay = 1.0f - 0.5f * g.yy;
    float half_cross = 0.5f * g.xy * g.yx;
    float inv_det = lean_reciprocal(ax * ay - 0.5f * half_cross);
    float mxx = (ay * g.xx + half_cross) * inv_det; // M = (I - G/2)^-1 G
    float mxy = g.xy * inv_det;
    float myx = g.yx * inv_det;
    float myy = (ax * g.yy + half_cross) * inv_det;
    float exx = (v.xx + mxx) + (mxx * v.xx + mxy * v.xy); // N - I, N = (I + M) V
    float exy = (v.xy + mxy) + (mxx * v.xy + mxy * v.yy);
    float eyx = (v.xy + myx) + (myx * v.xx + myy * v.xy);
    float eyy = (v.yy + myy) + (myx * v.xy + myy * v.yy);
    float x = 2.0f + (exx + eyy);
    float y = eyx - exy;
    float n2 = x * x + y * y;
    bool turns = n2 > 1.0e-28f;
    float n = lean_root(turns ? n2 : 1.0f);
    float inv_n = lean_reciprocal(n);
    float sn = turns ? y * inv_n : 0.0f;
    float half_turn = lean_quotient(y, x > 0.0f ? n + x : 1.0f); // tangent of half the angle
    float turned = turns ? x * inv_n - 1.0f : 0.0f;
    float cs_less_one = x > 0.0f ? -(half_turn * sn) : turned;
    float cs = 1.0f + cs_less_one;
    Stretch r;
    r.xx = (exx * cs - exy * sn) + cs_less_one;
    r.yy = (eyx * sn + eyy * cs) + cs_less_one;
    r.xy = 0.5f * ((exx - eyy) * sn + (exy + eyx) * cs);
    return r;
}

struct Turn {
    float cs, sn, cs_less_one;
};

// A component of F - I, within what may be squared and summed up and stay finite on every device.
FN float bounded_strain(float e) { return wclamp(e, -1.0e14f, 1.0e14f); }

// Right stretch less the identity, and rotation, of F = I + e = R P.
FN Stretch right_stretch(float e_xx, float e_xy, float e_yx, float e_yy, REF(Turn) by) {
    float exx = bounded_strain(e_xx);
    float exy = bounded_strain(e_xy);
    float eyx = bounded_strain(e_yx);
    float eyy = bounded_strain(e_yy);
    float x = 2.0f + (exx + eyy);
    float y = eyx - exy;
    float n = wsqrt(x * x + y * y);
    float safe_n = n > 0.0f ? n : 1.0f;
    by.cs = n > 0.0f ? wdiv(x, safe_n) : 1.0f;
    by.sn = wdiv(y, safe_n);
    float den = safe_n * (safe_n + x);
    float safe_den = x > 0.0f ? den : 1.0f;
    float small = -wdiv(y * y, safe_den);
    by.cs_less_one = x > 0.0f ? small : by.cs - 1.0f;
    Stretch r;
    r.xx = (by.cs * exx + by.sn * eyx) + by.cs_less_one;
    r.yy = (by.cs * eyy - by.sn * exy) + by.cs_less_one;
    r.xy = 0.5f * ((exy + eyx) * by.cs + (eyy - exx) * by.sn);
    return r;
}

// R^T G R.
FN Gradient turned_back(Gradient g, float cs, float sn) {
    float mean = 0.5f * (g.xx + g.yy);
    float spin = 0.5f * (g.yx - g.xy);
    float along = 0.5f * (g.xx - g.yy);
    float across = 0.5f * (g.xy + g.yx);
    float c2 = cs * cs - sn * sn;
    float s2 = 2.0f * (sn * cs);
    float along_back = along * c2 + across * s2;
    float across_back = across * c2 - along * s2;
    Gradient h;
    h.xx = mean + along_back;
    h.yy = mean - along_back;
    h.xy = across_back - spin;
    h.yx = across_back + spin;
    return h;
}

// R S R^T.
FN Stress turned_forward(Stress s, float cs, float sn) {
    float mean = 0.5f * (s.xx + s.yy);
    float along = 0.5f * (s.xx - s.yy);
    float c2 = cs * cs - sn * sn;
    float s2 = 2.0f * (sn * cs);
    float along_forward = along * c2 - s.xy * s2;
    Stress r;
    r.xx = mean + along_forward;
    r.yy = mean - along_forward;
    r.xy = s.xy * c2 + along * s2;
    return r;
}

// Piecewise linear cohesion against saturation (paper Fig. 3) [Pa].
FN float cohesion(float phi, float c0, float c1, float phi1, float phi2, float phi3, float slope01, float slope12, float slope23) {
    float rise = c0 + phi * slope01;
    float hold = c1 + (phi - phi1) * slope12;
    float fall = (phi3 - phi) * slope23;
    float c = phi < phi1 ? rise : (phi < phi2 ? hold : fall);
    return phi > phi3 ? 0.0f : c;
}

// Viscous stress that takes the mean stress no further than the yield surface does, so that what bears no tension does not
// get any from moving.
FN float bounded_viscosity(float viscous, float mean, float least, float largest) {
    return wclamp(viscous, wmin(least - mean, 0.0f), wmax(largest - mean, 0.0f));
}

// Yield: Hencky strain of V, compression cap, Drucker-Prager cone with its tip, back to V and to the Cauchy stress.
// c: cohesion [Pa]; cap: passive pressure K rho_s g hs [Pa].
FN void project_stretch(REF(Stretch) v, REF(Stress) stress, float c, float cap, float bulk, float inv_bulk, float two_shear, float inv_two_shear,
                        float yield_slope, float inv_yield_slope, float inv_friction_yield) {
    // The trace of ln V from det V, its deviator from the ratio of half difference to half sum of the principal stretches: by one series,
    // without roots or angles. Stretches beyond e^+-1/2 count as these.
    float sum = v.xx + v.yy;
    float grown = sum + (v.xx * v.yy - v.xy * v.xy); // det V - 1
    bool sound = both(grown > -0.999999f, both(sum > -2.0f, sum < 998.0f));
    float middle = 0.5f * sum; // of both stretches, less 1
    float d = 0.5f * (v.xx - v.yy);
    float xy = v.xy;
    float apart2 = d * d + xy * xy;
    float room = wmin(0.648725f - middle, middle + 0.393474f); // with as much slack as below
    bool within = both(room >= 0.0f, apart2 <= room * room);
    float volume = 1.0f + grown;
    if (UNIFORM(!within)) {
        // The floats near e^-1/2 - 1 and e^1/2 - 1 for which det V - 1 is 0 below where both bounds act: stiff sand is pushed by 3e-8.
        float apart = lean_root(wclamp(apart2, 1.0e-28f, 1.0e28f));
        float high = wclamp(middle + apart, -0.393469363f, 0.648721337f);
        float low = wclamp(middle - apart, -0.393469363f, 0.648721337f);
        float left_apart = lean_quotient(0.5f * (high - low), apart);
        d = within ? d : d * left_apart;
        xy = within ? xy : xy * left_apart;
        middle = within ? middle : 0.5f * (high + low);
        grown = within ? grown : (high + low) + high * low;
    }
    float s = lean_quotient(grown, 2.0f + grown); // tanh of half the trace
    float tr = 2.0f * s * arc_tanh_over(s * s);
    float inv_middle = lean_reciprocal(1.0f + middle);
    float dd = d * inv_middle;
    float dxy = xy * inv_middle;
    float per_ratio = arc_tanh_over(dd * dd + dxy * dxy);
    dd = dd * per_ratio;
    dxy = dxy * per_ratio;
    float size2 = 2.0f * (dd * dd + dxy * dxy);

    float least_tr = -(cap + c * inv_friction_yield) * inv_bulk;
    // What was projected before comes back within rounding of the surface: it yields again only clearly beyond it.
    float slack = 1.0f + 4.0e-6f;
    bool capped = tr < least_tr * slack;
    tr = capped ? least_tr : tr;
    float y = yield_slope * tr - c;
    bool tip = y >= -1.0e-20f; // a denormal is 0 on some GPUs
    float limit = -y * inv_two_shear;
    float allowed = limit * slack;
    bool beyond = size2 > wmax(allowed * allowed, 1.0e-28f);
    bool elastic = both(both(both(sound, within), !capped), both(!tip, !beyond));
    // Where nothing yields V stays as it is: the way through log and exp would move it by rounding for ever, and a strained
    // pile at rest would not be a fixed point.
    if (UNIFORM(!elastic)) {
        float shrink = lean_quotient(limit, lean_root(wmax(size2, 1.0e-28f)));
        shrink = beyond ? shrink : 1.0f;
        shrink = tip ? 0.0f : shrink;
        float left = tip ? c * inv_yield_slope : tr;
        left = sound ? left : 0.0f;
        float left_dd = sound ? dd * shrink : 0.0f;
        float left_dxy = sound ? dxy * shrink : 0.0f;
        float em = exp_minus_one(0.5f * left);
        float e = 1.0f + em;
        float hh = left_dd * left_dd + left_dxy * left_dxy;
        float grows = em + e * cosh_minus_one(hh);
        float sh = e * sinh_over(hh);
        v.xx = elastic ? v.xx : flush(grows + sh * left_dd);
        v.yy = elastic ? v.yy : flush(grows - sh * left_dd);
        v.xy = elastic ? v.xy : flush(sh * left_dxy);
        tr = elastic ? tr : left;
        dd = elastic ? dd : left_dd;
        dxy = elastic ? dxy : left_dxy;
        volume = elastic ? volume : e * e;
    }
    float inv_j = lean_reciprocal(volume);
    float mean = bulk * tr;
    stress.xx = (mean + two_shear * dd) * inv_j;
    stress.yy = (mean - two_shear * dd) * inv_j;
    stress.xy = two_shear * dxy * inv_j;
}

#endif
