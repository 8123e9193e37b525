// Hencky strain of a stretch of any size and back (paper 3.3.2; NUMERICS 2.22): strain.glsl's own is cut to what sand of `robust` bears.
#ifndef PHYSICS_LOG_STRAIN
#define PHYSICS_LOG_STRAIN
#include "../physics/strain.glsl"

// 0.5 ln(1 + x) for 1 + x clamped to [e^-1, e]: the log-strain of a squared stretch, within +-0.5.
FN float half_log(float x) {
    float y = wclamp(x, -0.632120559f, 1.71828183f);
    float s = lean_quotient(y, (2.0f + y) + 2.0f * lean_root(1.0f + y)); // (sqrt(1+y)-1)/(sqrt(1+y)+1), |s| <= 0.245
    float t = s * s;
    float series = 0.333333333f + t * (0.2f + t * (0.142857143f + t * (0.111111111f + t * (0.0909090909f + t * 0.0769230769f))));
    return 2.0f * s + 2.0f * s * t * series;
}

// 0.5 ln(1 + y) for any 1 + y above 0. Near 1 the argument keeps the digits of y.
FN float half_log_far(float y) {
    float x = 1.0f + y;
    int bits = float_bits(x);
    int twos = (bits - 0x3f3504f3) >> 23; // 1 + y = 2^twos f, f from sqrt(0.5) to sqrt(2)
    float reduced = bits_float(bits - twos * 8388608) - 1.0f;
    return half_log(twos == 0 ? y : reduced) + 0.346573590f * float(twos);
}

// e^x - 1 within the range of floats.
FN float exp_minus_one_far(float x) {
    float within = wclamp(x, -80.0f, 80.0f);
    float twos = wabs(within) <= 0.5f ? 0.0f : wfloor(within * 1.44269504f + 0.5f);
    float rest = (within - twos * 0.693145752f) - twos * 1.42860677e-6f;
    float scale = bits_float((int(twos) + 127) * 8388608);
    return scale * exp_minus_one(rest) + (scale - 1.0f);
}

// Logarithmic strain: trace and deviator; sound: 0 where the stretch has no logarithm.
struct LogStrain {
    float tr, dd, dxy, sound;
};

FN LogStrain log_strain(Stretch stretch) {
    Stretch p; // whose squares' roots stages can take
    p.xx = wclamp(stretch.xx, -1.0e7f, 1.0e7f);
    p.yy = wclamp(stretch.yy, -1.0e7f, 1.0e7f);
    p.xy = wclamp(stretch.xy, -1.0e7f, 1.0e7f);
    bool within = both(both(p.xx == stretch.xx, p.yy == stretch.yy), p.xy == stretch.xy);
    float bxx = 2.0f * p.xx + (square(p.xx) + square(p.xy)); // P P - I
    float byy = 2.0f * p.yy + (square(p.yy) + square(p.xy));
    float bxy = 2.0f * p.xy + p.xy * (p.xx + p.yy);
    float m = 0.5f * (bxx + byy);
    float d = 0.5f * (bxx - byy);
    float r = wsqrt(square(d) + square(bxy));
    float det = (1.0f + p.xx) * (1.0f + p.yy) - p.xy * p.xy;
    float large = 1.0f + (m + r);
    bool sound = both(both(det > 1.0e-15f, within), 2.0f + (p.xx + p.yy) > 0.0f);
    // Where P P is nearly singular its smaller eigenvalue comes from the determinant.
    float far = divide_or_zero(det * det, large) - 1.0f;
    float least = m - r < -0.5f ? far : m - r;
    float e1 = half_log_far(sound ? m + r : 0.0f);
    float e2 = half_log_far(sound ? least : 0.0f);
    float along = divide_or_zero(0.5f * (e1 - e2), r); // per unit of (d, bxy): no angle needed
    LogStrain e;
    e.tr = e1 + e2;
    e.dd = sound ? along * d : 0.0f;
    e.dxy = sound ? along * bxy : 0.0f;
    e.sound = sound ? 1.0f : 0.0f;
    return e;
}

// Drucker-Prager with cohesion c as printed (paper 3.3.2): the tip where the strain opens the sand beyond it, else the cone. What lies
// within keeps its bits; what has no logarithm starts again from the identity.
FN Stretch yielded(Stretch p, float c, float yield_slope, float inv_yield_slope, float inv_two_shear) {
    LogStrain e = log_strain(p);
    float y = yield_slope * e.tr - c;
    bool tip = y >= 0.0f;
    float limit = wmin(-y * inv_two_shear, 1.0e30f);
    float size = 1.41421356f * wsqrt(square(e.dd) + square(e.dxy));
    bool beyond = size > limit;
    float cone = divide_or_zero(limit, size);
    float shrink = tip ? 0.0f : cone;
    float tr = tip ? c * inv_yield_slope : e.tr;
    float dd = e.dd * shrink;
    float dxy = e.dxy * shrink;
    float h = wsqrt(square(dd) + square(dxy));
    float up = exp_minus_one_far(0.5f * tr + h);
    float down = exp_minus_one_far(0.5f * tr - h);
    float middle = 0.5f * (up + down);
    float apart = divide_or_zero(0.5f * (up - down), h);
    Stretch q;
    q.xx = middle + apart * dd;
    q.yy = middle - apart * dd;
    q.xy = apart * dxy;
    bool yields = either(tip, beyond);
    q.xx = yields ? q.xx : p.xx;
    q.yy = yields ? q.yy : p.yy;
    q.xy = yields ? q.xy : p.xy;
    q.xx = e.sound > 0.0f ? q.xx : 0.0f;
    q.yy = e.sound > 0.0f ? q.yy : 0.0f;
    q.xy = e.sound > 0.0f ? q.xy : 0.0f;
    return q;
}

// Cauchy stress of a right stretch [Pa], in the frame of its rotation (Klar et al. 2016).
FN Stress hencky_stress(Stretch p, float bulk, float two_shear) {
    LogStrain e = log_strain(p);
    float det = (1.0f + p.xx) * (1.0f + p.yy) - p.xy * p.xy;
    float inv_det = divide_or_zero(e.sound, det);
    Stress s;
    s.xx = (bulk * e.tr + two_shear * e.dd) * inv_det;
    s.yy = (bulk * e.tr - two_shear * e.dd) * inv_det;
    s.xy = two_shear * e.dxy * inv_det;
    return s;
}

#endif
