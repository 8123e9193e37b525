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

// 0.5 ln(1 + x) for 1 + x clamped to [e^-1, e]: the log-strain of a squared stretch, within +-0.5.
FN float half_log(float x) {
    float y = wclamp(x, -0.632120559f, 1.71828183f);
    float s = lean_quotient(y, (2.0f + y) + 2.0f * lean_root(1.0f + y)); // (sqrt(1+y)-1)/(sqrt(1+y)+1), |s| <= 0.245
    float t = s * s;
    float series = 0.333333333f + t * (0.2f + t * (0.142857143f + t * (0.111111111f + t * (0.0909090909f + t * 0.0769230769f))));
    return 2.0f * s + 2.0f * s * t * series;
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

// One-sided at the rim of the sand (NUMERICS 2.6): dry neighbours say nothing about the velocity gradient.
FN float across_gradient(float low, float centre, float high, bool wet_low, bool wet_high, float k, float other) {
    float both_sides = 0.5f * k * (high - low);
    float upper = k * (high - centre);
    float lower = k * (centre - low);
    float one = wet_high ? upper : (wet_low ? lower : -other);
    return both(wet_low, wet_high) ? both_sides : one;
}

// dts grad v of a cell: velocities of its four faces, mean velocities of the cells around along the other axis.
FN Gradient velocity_gradient(float u_w, float u_e, float v_s, float v_n, float u_s, float u_n, float v_w, float v_e, bool wet_w, bool wet_e, bool wet_s,
                              bool wet_n, float k, float limit) {
    float u_c = 0.5f * (u_w + u_e);
    float v_c = 0.5f * (v_s + v_n);
    bool any_y = either(wet_s, wet_n);
    bool any_x = either(wet_w, wet_e);
    float yx_alone = across_gradient(v_w, v_c, v_e, wet_w, wet_e, k, 0.0f);
    float xy = across_gradient(u_s, u_c, u_n, wet_s, wet_n, k, any_x ? yx_alone : 0.0f);
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
    float quarter = 0.25f * g.xy * g.yx;
    float inv_det = lean_quotient(1.0f, ax * ay - quarter);
    float mxx = (ay * g.xx + 0.5f * g.xy * g.yx) * inv_det; // M = (I - G/2)^-1 G
    float mxy = g.xy * inv_det;
    float myx = g.yx * inv_det;
    float myy = (ax * g.yy + 0.5f * g.xy * g.yx) * inv_det;
    float exx = (v.xx + mxx) + (mxx * v.xx + mxy * v.xy); // N - I, N = (I + M) V
    float exy = (v.xy + mxy) + (mxx * v.xy + mxy * v.yy);
    float eyx = (v.xy + myx) + (myx * v.xx + myy * v.xy);
    float eyy = (v.yy + myy) + (myx * v.xy + myy * v.yy);
    float x = 2.0f + (exx + eyy);
    float y = eyx - exy;
    float n = wsqrt(x * x + y * y);
    float safe_n = n > 0.0f ? n : 1.0f;
    float inv_n = lean_quotient(1.0f, safe_n);
    float sn = y * inv_n;
    float den = safe_n * (safe_n + x);
    float safe_den = x > 0.0f ? den : 1.0f;
    float small = -lean_quotient(y * y, safe_den);
    float turned = n > 0.0f ? x * inv_n : 1.0f;
    float cs = x > 0.0f ? 1.0f + small : turned;
    float cs_less_one = x > 0.0f ? small : cs - 1.0f;
    Stretch r;
    r.xx = (exx * cs - exy * sn) + cs_less_one;
    r.yy = (eyx * sn + eyy * cs) + cs_less_one;
    r.xy = 0.5f * ((exx - eyy) * sn + (exy + eyx) * cs);
    return r;
}

struct Turn {
    float cs, sn, cs_less_one;
};

// Right stretch less the identity, and rotation, of F = I + e = R P.
FN Stretch right_stretch(float e_xx, float e_xy, float e_yx, float e_yy, REF(Turn) by) {
    float exx = wclamp(e_xx, -1.0e14f, 1.0e14f); // what is squared below stays finite
    float exy = wclamp(e_xy, -1.0e14f, 1.0e14f);
    float eyx = wclamp(e_yx, -1.0e14f, 1.0e14f);
    float eyy = wclamp(e_yy, -1.0e14f, 1.0e14f);
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
    float bxx = 2.0f * v.xx + (square(v.xx) + square(v.xy)); // V V^T - I
    float byy = 2.0f * v.yy + (square(v.yy) + square(v.xy));
    float bxy = 2.0f * v.xy + v.xy * (v.xx + v.yy);
    float m = 0.5f * (bxx + byy);
    float d = 0.5f * (bxx - byy);
    float r = wsqrt(square(d) + square(bxy));
    float det = (1.0f + v.xx) * (1.0f + v.yy) - v.xy * v.xy;
    float e1 = half_log(m + r);
    float e2 = half_log(m - r);
    bool within = both(m + r <= 1.71828183f, m - r >= -0.632120559f); // half_log clamps neither
    float tr = e1 + e2;
    float along = lean_divide_or_zero(0.5f * (e1 - e2), r); // half-difference per unit of (d, bxy): no angle needed
    float dd = along * d;
    float dxy = along * bxy;

    Stretch before = v;
    float least_tr = -(cap + c * inv_friction_yield) * inv_bulk;
    // What was projected before comes back within rounding of the surface: it yields again only clearly beyond it.
    float slack = 1.0f + 4.0e-6f;
    bool elastic = tr >= least_tr * slack;
    tr = elastic ? tr : least_tr;
    float y = yield_slope * tr - c;
    bool tip = y >= 0.0f;
    float limit = -y * inv_two_shear;
    float size = 0.707106781f * (e1 - e2);
    bool beyond = size > limit * slack;
    float shrink = beyond ? lean_divide_or_zero(limit, size) : 1.0f;
    shrink = tip ? 0.0f : shrink;
    tr = tip ? c * inv_yield_slope : tr;
    dd = dd * shrink;
    dxy = dxy * shrink;

    bool broken = !both(det > 1.0e-6f, m + r < 1.0e6f);
    tr = broken ? 0.0f : tr;
    dd = broken ? 0.0f : dd;
    dxy = broken ? 0.0f : dxy;

    elastic = both(both(both(elastic, within), !tip), both(!broken, !beyond));

    float em = exp_minus_one(0.5f * tr);
    float e = 1.0f + em;
    // Where nothing yields V stays as it is: the way through log and exp would move it by rounding for ever, and a strained
    // pile at rest would not be a fixed point.
    if (UNIFORM(!elastic)) {
        float hh = square(dd) + square(dxy);
        float ch = cosh_minus_one(hh);
        float sh = e * sinh_over(hh);
        v.xx = elastic ? before.xx : (em + e * ch) + sh * dd;
        v.yy = elastic ? before.yy : (em + e * ch) - sh * dd;
        v.xy = elastic ? before.xy : sh * dxy;
    }
    float inv_j = lean_quotient(1.0f, e * e);
    float mean = bulk * tr;
    stress.xx = (mean + two_shear * dd) * inv_j;
    stress.yy = (mean - two_shear * dd) * inv_j;
    stress.xy = two_shear * dxy * inv_j;
}

#endif
