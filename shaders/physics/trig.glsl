// Sine, cosine and angle of a vector from + - * / and roots alone, so that all backends give the same bits (paper 4.2.2,
// NUMERICS 2.13). Odd functions are odd in every bit, for mirrored scenes.
#ifndef PHYSICS_TRIG
#define PHYSICS_TRIG
#include "../physics/scalar.glsl"

#define PI_FLOAT 3.14159274f
#define TWO_PI 6.28318548f

// An angle within (-3 pi, 3 pi) to the same angle within [-pi, pi].
FN float wrap_angle(float a) {
    float down = a > PI_FLOAT ? a - TWO_PI : a;
    return a < -PI_FLOAT ? a + TWO_PI : down;
}

// |x| <= 1.25 pi: Taylor series about the nearest quarter turn, absolute error below 2e-7.
FN void sine_cosine(float x, REF(float) sine, REF(float) cosine) {
    float quarter = wtrunc(x * 0.636619772f + (x < 0.0f ? -0.5f : 0.5f));
    float r = (x - quarter * 1.57079637f) + quarter * 4.37113883e-8f; // pi/2 in two parts
    float z = r * r;
    float s = r + r * z * (-0.166666667f + z * (8.33333333e-3f + z * (-1.98412698e-4f + z * 2.75573192e-6f)));
    float c = 1.0f + z * (-0.5f + z * (4.16666667e-2f + z * (-1.38888889e-3f + z * (2.48015873e-5f - z * 2.75573192e-7f))));
    bool odd = wabs(quarter) == 1.0f;
    float s1 = odd ? quarter * c : s;
    float c1 = odd ? -(quarter * s) : c;
    bool turned = wabs(quarter) > 1.5f;
    sine = turned ? -s1 : s1;
    cosine = turned ? -c1 : c1;
}

// Angle of the vector (x, y) within [-pi, pi], 0 for the zero vector: halved twice, then the series of the arc tangent up to
// the ninth power of at most tan(pi/16).
FN float angle_of(float x, float y) {
    float size_x = wabs(x);
    float size_y = wabs(y);
    float t = divide_or_zero(wmin(size_x, size_y), wmax(size_x, size_y));
    float halved = wdiv(t, 1.0f + wsqrt(1.0f + t * t));
    float q = wdiv(halved, 1.0f + wsqrt(1.0f + halved * halved));
    float z = q * q;
    float a = 4.0f * (q + q * z * (-0.333333333f + z * (0.2f + z * (-0.142857143f + z * 0.111111111f))));
    float steep = size_y > size_x ? 1.57079637f - a : a;
    float back = x < 0.0f ? PI_FLOAT - steep : steep;
    return y < 0.0f ? -back : back;
}

#endif
