// Scalar building blocks that mean the same in GLSL, C++ and CUDA.
#ifndef PHYSICS_SCALAR
#define PHYSICS_SCALAR

// As x86 computes them in one instruction. Which of two zeros wins, and what becomes of NaN, is the prelude's choice.
#ifndef HAS_MIN_MAX
FN float wmin(float a, float b) { return b < a ? b : a; }
FN float wmax(float a, float b) { return a < b ? b : a; }
#endif
FN float wclamp(float x, float low, float high) { return wmin(wmax(x, low), high); }

// No denormal and no negative zero leaves a stage: some GPUs flush denormals and others keep them.
FN float flush(float x) { return wabs(x) < 1.0e-20f ? 0.0f : x; }

// x*x, 0 where it would come near the denormals: a root of it would be 0 on one GPU and x on another.
FN float square(float x) {
    float s = x * x;
    return s < 1.0e-36f ? 0.0f : s;
}

// a/b where b may be zero: 0 there.
FN float divide_or_zero(float a, float b) {
    float safe = b > 0.0f ? b : 1.0f;
    float q = wdiv(a, safe);
    return b > 0.0f ? q : 0.0f;
}

// The same where a/b and its operands lie in the range of lean_quotient (shaders/README).
FN float lean_divide_or_zero(float a, float b) {
    float q = lean_quotient(a, b > 0.0f ? b : 1.0f);
    return b > 0.0f ? q : 0.0f;
}

FN float lean_reciprocal_or_zero(float b) {
    float q = lean_reciprocal(b > 0.0f ? b : 1.0f);
    return b > 0.0f ? q : 0.0f;
}

// Minmod: the smaller of two slopes where they agree in sign, else 0. All of it minima and maxima: where a condition chose, g++ would
// sink the loads of a and b behind it, and the row would not vectorise.
FN float minmod(float a, float b) { return wmax(wmin(a, b), 0.0f) + wmin(wmax(a, b), 0.0f); }

// Volumes are moved in whole quanta (NUMERICS 2.2): toward zero, so that a limited outflow stays limited.
FN float whole_quanta(float volume, float quantum, float inv_quantum) {
    float t = wtrunc(volume * inv_quantum) * quantum;
    return quantum > 0.0f ? t : volume;
}

#endif
