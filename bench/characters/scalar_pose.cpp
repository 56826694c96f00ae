#include "bench/characters/scalar_pose.h"

#include <algorithm>
#include <cmath>

namespace limn::bench {
namespace {

void mix_rotation(const float* a, const float* b, float u, float* out) {
    const float dot = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
    const float v = dot < 0 ? -u : u;
    float q[4];
    for (int i = 0; i < 4; ++i) {
        q[i] = a[i] * (1 - u) + b[i] * v;
    }
    const float unit = 1 / std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (int i = 0; i < 4; ++i) {
        out[i] = q[i] * unit;
    }
}

/// out = a * b, rows of 3x4 matrices.
void multiply(const float* a, const float* b, float* out) {
    for (int row = 0; row < 3; ++row) {
        const float* const r = a + 4 * row;
        for (int column = 0; column < 4; ++column) {
            out[4 * row + column] = r[0] * b[column] + r[1] * b[4 + column] + r[2] * b[8 + column];
        }
        out[4 * row + 3] += r[3];
    }
}

}  // namespace

void sample_scalar(const ScalarClip& clip, float time, float* q, float* t) {
    const float at = time * clip.rate;
    const std::size_t first = std::min(static_cast<std::size_t>(at), clip.frames - 2);
    const float u = at - static_cast<float>(first);
    const float* qa = clip.rotations.data() + first * clip.joints * 4;
    const float* qb = qa + clip.joints * 4;
    const float* ta = clip.translations.data() + first * clip.joints * 3;
    const float* tb = ta + clip.joints * 3;
    blend_scalar(qa, ta, qb, tb, u, clip.joints, q, t);
}

void blend_scalar(
    const float* qa, const float* ta, const float* qb, const float* tb, float weight,
    std::size_t joints, float* q, float* t) {
    for (std::size_t j = 0; j < joints; ++j) {
        mix_rotation(qa + 4 * j, qb + 4 * j, weight, q + 4 * j);
        for (std::size_t i = 3 * j; i < 3 * j + 3; ++i) {
            t[i] = ta[i] * (1 - weight) + tb[i] * weight;
        }
    }
}

void multiply_scalar(
    const std::int32_t* parents, const float* q, const float* t, std::size_t joints, float* model) {
    for (std::size_t j = 0; j < joints; ++j) {
        const float x = q[4 * j];
        const float y = q[4 * j + 1];
        const float z = q[4 * j + 2];
        const float w = q[4 * j + 3];
        const float local[12] = {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),
                                 2 * (x * z + w * y),     t[3 * j],
                                 2 * (x * y + w * z),     1 - 2 * (x * x + z * z),
                                 2 * (y * z - w * x),     t[3 * j + 1],
                                 2 * (x * z - w * y),     2 * (y * z + w * x),
                                 1 - 2 * (x * x + y * y), t[3 * j + 2]};
        if (parents[j] < 0) {
            std::copy(local, local + 12, model + 12 * j);
        } else {
            multiply(model + 12 * parents[j], local, model + 12 * j);
        }
    }
}

void skin_scalar(const float* model, const float* bind, std::size_t joints, float* out) {
    for (std::size_t j = 0; j < joints; ++j) {
        multiply(model + 12 * j, bind + 12 * j, out + 12 * j);
    }
}

void skin_vertices_scalar(
    const float* palette, const std::uint16_t* joints, const float* weights, int influences,
    const float* positions, const float* normals, std::size_t count, float* out_positions,
    float* out_normals) {
    for (std::size_t v = 0; v < count; ++v) {
        float m[12] = {};
        for (int k = 0; k < influences; ++k) {
            const float weight =
                weights[static_cast<std::size_t>(influences) * v + static_cast<std::size_t>(k)];
            const float* const joint =
                palette
                + 12
                      * joints
                          [static_cast<std::size_t>(influences) * v + static_cast<std::size_t>(k)];
            for (int i = 0; i < 12; ++i) {
                m[i] += weight * joint[i];
            }
        }
        const float* const p = positions + 3 * v;
        const float* const n = normals + 3 * v;
        float normal[3];
        for (int row = 0; row < 3; ++row) {
            const float* const r = m + 4 * row;
            out_positions[3 * v + static_cast<std::size_t>(row)] =
                r[0] * p[0] + r[1] * p[1] + r[2] * p[2] + r[3];
            normal[row] = r[0] * n[0] + r[1] * n[1] + r[2] * n[2];
        }
        const float unit =
            1 / std::sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
        for (std::size_t row = 0; row < 3; ++row) {
            out_normals[3 * v + row] = normal[row] * unit;
        }
    }
}

}  // namespace limn::bench
