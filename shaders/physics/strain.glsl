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
    float s = wdiv(y, (2.0f + y) + 2.0f * wsqrt(1.0f + y)); // (sqrt(1+y)-1)/(sqrt(1+y)+1), |s| <= 0.245
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

// Evolution by the Cayley form (I - G/2)^-1 (I + G/2), which rotates without stretching, then back to the left stretch.
FN Stretch evolve_stretch(Stretch v, Gradient g) {
    float ax = 1.0f - 0.5f * g.xx;
    float ay = 1.0f - 0.5f * g.yy;
    float quarter = 0.25f * g.xy * g.yx;
    float inv_det = wdiv(1.0f, ax * ay - quarter);
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
    float cs = n > 0.0f ? wdiv(x, safe_n) : 1.0f;
    float sn = wdiv(y, safe_n);
    float den = safe_n * (safe_n + x);
    float safe_den = x > 0.0f ? den : 1.0f;
    float small = -wdiv(y * y, safe_den);
    float cs_less_one = x > 0.0f ? small : cs - 1.0f;
    Stretch r;
    r.xx = (exx * cs - exy * sn) + cs_less_one;
    r.yy = (eyx * sn + eyy * cs) + cs_less_one;
    r.xy = 0.5f * ((exx - eyy) * sn + (exy + eyx) * cs);
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
    float along = divide_or_zero(0.5f * (e1 - e2), r); // half-difference per unit of (d, bxy): no angle needed
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
    float size = wsqrt(2.0f * (square(dd) + square(dxy)));
    bool beyond = size > limit * slack;
    float shrink = beyond ? divide_or_zero(limit, size) : 1.0f;
    shrink = tip ? 0.0f : shrink;
    tr = tip ? c * inv_yield_slope : tr;
    dd = dd * shrink;
    dxy = dxy * shrink;

    bool broken = !both(det > 1.0e-6f, m + r < 1.0e6f);
    tr = broken ? 0.0f : tr;
    dd = broken ? 0.0f : dd;
    dxy = broken ? 0.0f : dxy;

    elastic = both(both(both(elastic, within), !tip), both(!broken, !beyond));

    float hh = square(dd) + square(dxy);
    float em = exp_minus_one(0.5f * tr);
    float e = 1.0f + em;
    float ch = cosh_minus_one(hh);
    float sh = e * sinh_over(hh);
    v.xx = (em + e * ch) + sh * dd;
    v.yy = (em + e * ch) - sh * dd;
    v.xy = sh * dxy;
    // Where nothing yields V stays as it is: the way through log and exp would move it by rounding for ever, and a strained
    // pile at rest would not be a fixed point.
    v.xx = elastic ? before.xx : v.xx;
    v.xy = elastic ? before.xy : v.xy;
    v.yy = elastic ? before.yy : v.yy;
    float inv_j = wdiv(1.0f, e * e);
    float mean = bulk * tr;
    stress.xx = (mean + two_shear * dd) * inv_j;
    stress.yy = (mean - two_shear * dd) * inv_j;
    stress.xy = two_shear * dxy * inv_j;
}

#endif
