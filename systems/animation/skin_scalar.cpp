#include "systems/animation/skin_scalar.h"

#include "ecs/base/check.h"
#include "ecs/base/rotation.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

namespace limn {
namespace skin {
namespace {

float dot_product(const Vec3& a, const Vec3& b) {
    return (a.x * b.x + a.y * b.y) + a.z * b.z;
}
Vec3 cross_product(const Vec3& a, const Vec3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

Vec3 turn(const Affine& m, const Vec3& v) {
    return {
        dot_product(Vec3(m.row[0]), v), dot_product(Vec3(m.row[1]), v),
        dot_product(Vec3(m.row[2]), v)};
}

/// Matrix of a dual quaternion, which need not be normalized; `real` must not be 0.
Affine matrix_of(const DualQuaternion& motion) {
    const auto [w, x, y, z] =
        std::tuple(motion.real.w, motion.real.x, motion.real.y, motion.real.z);
    const auto [dw, dx, dy, dz] =
        std::tuple(motion.dual.w, motion.dual.x, motion.dual.y, motion.dual.z);
    const float s = 2.0f / (((x * x + y * y) + z * z) + w * w);
    const float xx = s * (x * x);
    const float yy = s * (y * y);
    const float zz = s * (z * z);
    const float xy = s * (x * y);
    const float xz = s * (x * z);
    const float yz = s * (y * z);
    const float wx = s * (w * x);
    const float wy = s * (w * y);
    const float wz = s * (w * z);
    Affine m;
    m.row[0] = {1.0f - (yy + zz), xy - wz, xz + wy, s * ((w * dx - dw * x) + (y * dz - z * dy))};
    m.row[1] = {xy + wz, 1.0f - (xx + zz), yz - wx, s * ((w * dy - dw * y) + (z * dx - x * dz))};
    m.row[2] = {xz - wy, yz + wx, 1.0f - (xx + yy), s * ((w * dz - dw * z) + (x * dy - y * dx))};
    return m;
}
const Affine& matrix_of(const Affine& m) {
    return m;
}

Affine mean_matrix(const SkinWeights& skin, std::span<const Affine> palette, std::size_t v) {
    std::uint32_t i = skin.first[v];
    const std::uint32_t last = skin.first[v + 1];
    Affine mean;
    if (i < last) {
        for (int row = 0; row < 3; ++row) {
            mean.row[row] = skin.weights[i] * palette[skin.joints[i]].row[row];
        }
        for (++i; i < last; ++i) {
            for (int row = 0; row < 3; ++row) {
                mean.row[row] += skin.weights[i] * palette[skin.joints[i]].row[row];
            }
        }
    }
    return mean;
}
Affine
mean_matrix(const SkinWeights& skin, std::span<const DualQuaternion> palette, std::size_t v) {
    return matrix_of(mean_motion(skin, palette, v));
}

/// Rotates `rest` by the joint with the largest weight only.
template <typename Joint>
Vec3 turn_by_strongest(
    const SkinWeights& skin, std::span<const Joint> palette, const Vec3& rest, std::size_t v) {
    if (skin.first[v] == skin.first[v + 1]) {
        return rest;
    }
    const auto first = skin.weights.begin();
    const auto found = std::max_element(first + skin.first[v], first + skin.first[v + 1]);
    const std::uint16_t joint = skin.joints[static_cast<std::size_t>(found - first)];
    return normalize_or(turn(matrix_of(palette[joint]), rest), rest);
}

/// Transforms a normal by the inverse transpose of `mean`, the matrix of vertex `v`.
template <typename Joint>
Vec3 turn_normal(
    const Affine& mean, const SkinWeights& skin, std::span<const Joint> palette, const Vec3& rest,
    std::size_t v) {
    const Vec3 x(mean.row[0]);
    const Vec3 y(mean.row[1]);
    const Vec3 z(mean.row[2]);
    const Vec3 a = cross_product(y, z);
    const Vec3 n = {
        dot_product(a, rest), dot_product(cross_product(z, x), rest),
        dot_product(cross_product(x, y), rest)};
    const float length2 = dot_product(n, n);
    const float size = (dot_product(x, x) + dot_product(y, y)) + dot_product(z, z);
    return length2 > kFlat * (size * size)
               ? n * std::copysign(1.0f / std::sqrt(length2), dot_product(x, a))
               : turn_by_strongest(skin, palette, rest, v);
}

Vec4 turn_tangent(const Affine& mean, const Vec4& rest) {
    const Vec3 t = turn(mean, Vec3(rest));
    const float length2 = dot_product(t, t);
    return length2 > kNoLength ? Vec4(t * (1.0f / std::sqrt(length2)), rest.w) : rest;
}

template <typename Joint>
void move_vertices(
    const SkinWeights& skin, std::span<const Joint> palette, const RestVertices& rest,
    const SkinnedVertices& moved, std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
        const Affine mean = mean_matrix(skin, palette, v);
        if (!moved.normals.empty()) {
            moved.normals[v] = turn_normal(mean, skin, palette, rest.normals[v], v);
            moved.tangents[v] = turn_tangent(mean, rest.tangents[v]);
        }
        moved.positions[v] =
            turn(mean, rest.positions[v]) + Vec3(mean.row[0].w, mean.row[1].w, mean.row[2].w);
    }
}

}  // namespace

DualQuaternion
mean_motion(const SkinWeights& skin, std::span<const DualQuaternion> palette, std::size_t v) {
    std::uint32_t i = skin.first[v];
    const std::uint32_t last = skin.first[v + 1];
    DualQuaternion mean;
    if (i == last) {
        return mean;
    }
    const DualQuaternion& start = palette[skin.joints[i]];
    mean.real = skin.weights[i] * start.real;
    mean.dual = skin.weights[i] * start.dual;
    for (++i; i < last; ++i) {
        const DualQuaternion& next = palette[skin.joints[i]];
        const float weight = turns_away(start.real, next.real) ? -skin.weights[i] : skin.weights[i];
        mean.real += weight * next.real;
        mean.dual += weight * next.dual;
    }
    const Quat& r = mean.real;
    const float length2 = ((r.x * r.x + r.y * r.y) + r.z * r.z) + r.w * r.w;
    return length2 > kNoMotion ? mean : start;
}

Vec3 moved_normal(
    const SkinWeights& skin, std::span<const Affine> palette, const Vec3& rest, std::size_t v) {
    return turn_normal(mean_matrix(skin, palette, v), skin, palette, rest, v);
}

Vec3 moved_normal(
    const SkinWeights& skin, std::span<const DualQuaternion> palette, const Vec3& rest,
    std::size_t v) {
    return turn_normal(mean_matrix(skin, palette, v), skin, palette, rest, v);
}

}  // namespace skin

void compute_skin_palette(
    const SkinData& skin, std::span<const Affine> joints, std::span<Affine> palette) {
    LIMN_CHECK(palette.size() <= skin.joints.size());
    for (std::size_t i = 0; i < palette.size(); ++i) {
        palette[i] = joints[skin.joints[i]] * skin.joint_from_mesh[i];
    }
}

void compute_dual_palette(std::span<const Affine> palette, std::span<DualQuaternion> duals) {
    LIMN_CHECK(palette.size() == duals.size());
    for (std::size_t i = 0; i < palette.size(); ++i) {
        const Affine& m = palette[i];
        Mat3 axes;
        for (int k = 0; k < 3; ++k) {
            axes[k] = Vec3(m.row[0][k], m.row[1][k], m.row[2][k]);
        }
        const Quat real = extract_rotation(axes).value_or(Quat(1, 0, 0, 0));
        const Quat translation(0, m.row[0].w, m.row[1].w, m.row[2].w);
        duals[i] = {real, 0.5f * (translation * real)};
    }
}

void skin_linear_scalar(
    const SkinWeights& skin, std::span<const Affine> palette, const RestVertices& rest,
    const SkinnedVertices& moved, std::size_t begin, std::size_t end) {
    skin::move_vertices(skin, palette, rest, moved, begin, end);
}

void skin_dual_scalar(
    const SkinWeights& skin, std::span<const DualQuaternion> palette, const RestVertices& rest,
    const SkinnedVertices& moved, std::size_t begin, std::size_t end) {
    skin::move_vertices(skin, palette, rest, moved, begin, end);
}

void add_morphs(
    std::span<const MorphTarget> morphs, std::span<const float> weights,
    const SkinnedVertices& vertices) {
    const std::size_t count = std::min(morphs.size(), weights.size());
    for (std::size_t t = 0; t < count; ++t) {
        const MorphTarget& morph = morphs[t];
        const float weight = weights[t];
        if (weight == 0.0f) {
            continue;
        }
        for (std::size_t i = 0; i < morph.vertices.size(); ++i) {
            const std::uint32_t v = morph.vertices[i];
            vertices.positions[v] += weight * morph.positions[i];
            if (!morph.normals.empty() && !vertices.normals.empty()) {
                vertices.normals[v] += weight * morph.normals[i];
            }
            if (!morph.tangents.empty() && !vertices.tangents.empty()) {
                vertices.tangents[v] += Vec4(weight * morph.tangents[i], 0.0f);
            }
        }
    }
}

SkinWeights limit_influences(const SkinWeights& skin, std::size_t count) {
    LIMN_CHECK(count > 0);
    SkinWeights limited;
    std::vector<std::uint32_t> kept;
    for (std::size_t v = 0; v + 1 < skin.first.size(); ++v) {
        kept.clear();
        for (std::uint32_t i = skin.first[v]; i < skin.first[v + 1]; ++i) {
            kept.push_back(i);
        }
        std::stable_sort(kept.begin(), kept.end(), [&](std::uint32_t a, std::uint32_t b) {
            return skin.weights[a] > skin.weights[b];
        });
        kept.resize(std::min(kept.size(), count));
        std::sort(kept.begin(), kept.end());  // by joint again
        float sum = 0.0f;
        for (const std::uint32_t i : kept) {
            sum += skin.weights[i];
        }
        limited.first.push_back(static_cast<std::uint32_t>(limited.joints.size()));
        for (const std::uint32_t i : kept) {
            limited.joints.push_back(skin.joints[i]);
            limited.weights.push_back(skin.weights[i] / sum);
        }
    }
    limited.first.push_back(static_cast<std::uint32_t>(limited.joints.size()));
    return limited;
}

}  // namespace limn
