// Shadows of particles by Fourier opacity maps (Jansen and Bavoil, "Fourier Opacity Mapping", I3D 2010): along each ray
// of a light, the density as a Fourier series of three harmonics over the range of depths that holds particles. The
// integral of that series up to a point, negated, is the logarithm of the transmittance there: exact beyond the range,
// blurred within it, as the series is short. (render/particles/particle_shadow_pass.h)
// Techniques: particle.shadow

const float kTurn = 6.28318530718;
const float kMaxOpacity = 0.98;  // of a particle: an opaque one would have infinite optical depth

// The seven coefficients, in two texels: a0, a1, b1, a2; b2, a3, b3, 0.
struct OpacitySeries {
    vec4 low;
    vec4 high;
};

// Cosines and sines of t, 2 t and 3 t.
struct Harmonics {
    vec3 cosines;
    vec3 sines;
};
Harmonics harmonics(float t) {
    float c = cos(t);
    float s = sin(t);
    float c2 = c * c - s * s;
    float s2 = 2.0 * s * c;
    return Harmonics(vec3(c, c2, c2 * c - s2 * s), vec3(s, s2, s2 * c + c2 * s));
}

float sinc(float x) {
    return abs(x) < 1e-3 ? 1.0 - x * x / 6.0 : sin(x) / x;
}

// Of a slab of this opacity centered at `depth`, `thickness` deep (fractions of the range).
OpacitySeries slab_series(float opacity, float depth, float thickness) {
    float weight = -2.0 * log(1.0 - clamp(opacity, 0.0, kMaxOpacity));
    Harmonics h = harmonics(kTurn * depth);
    float half_turn = 0.5 * kTurn * thickness;
    vec3 blur = weight * vec3(sinc(half_turn), sinc(2.0 * half_turn), sinc(3.0 * half_turn));
    vec3 a = blur * h.cosines;
    vec3 b = blur * h.sines;
    return OpacitySeries(vec4(weight, a.x, b.x, a.y), vec4(b.y, a.z, b.z, 0.0));
}

// Of everything up to `depth`, a fraction of the range; >= 0.
float optical_depth(OpacitySeries series, float depth) {
    float d = clamp(depth, 0.0, 1.0);
    Harmonics h = harmonics(kTurn * d);
    vec3 a = vec3(series.low.y, series.low.w, series.high.y);
    vec3 b = vec3(series.low.z, series.high.x, series.high.z);
    vec3 waves = (a * h.sines + b * (1.0 - h.cosines)) / (kTurn * vec3(1.0, 2.0, 3.0));
    return max(0.5 * series.low.x * d + waves.x + waves.y + waves.z, 0.0);
}
