#include "render/skinning/rest_pool.h"

#include "render/geometry/culling.h"
#include "render/gpu/grown_buffer.h"
#include "render/shaders/deform_gpu.h"

#include <algorithm>
#include <bit>
#include <cmath>

// Techniques: char.skin-vertex-offset

namespace limn {
namespace {

constexpr std::uint32_t kInitialRestTexels = 1 << 14;
constexpr std::size_t kTexelBytes = 16;

using Texels = std::vector<layout::uvec4>;

layout::uint bits_of(float x) {
    return std::bit_cast<layout::uint>(std::isfinite(x) ? x : 0.0f);
}

/// Two components as 16-bit snorm fractions of kMaxUnitDifference.
layout::uint pack_snorm(float x, float y) {
    const auto one = [](float v) {
        const float fraction = std::isfinite(v) ? v / layout::kMaxUnitDifference : 0.0f;
        const long number = std::lround(std::clamp(fraction, -1.0f, 1.0f) * 32767.0f);
        return static_cast<layout::uint>(number) & 0xffffu;
    };
    return one(x) | one(y) << 16;
}

/// One target's offset of one vertex.
struct Offset {
    std::uint32_t target = 0;
    std::size_t entry = 0;
};

/// For each vertex, the targets that move it, in order.
std::vector<std::vector<Offset>> offsets_of_vertices(const MeshData& mesh) {
    std::vector<std::vector<Offset>> offsets(mesh.positions.size());
    for (std::uint32_t t = 0; t < mesh.morphs.size(); ++t) {
        const std::vector<std::uint32_t>& moved = mesh.morphs[t].vertices;
        for (std::size_t i = 0; i < moved.size(); ++i) {
            offsets[moved[i]].push_back({t, i});
        }
    }
    return offsets;
}

/// Unit axes of a vertex; the tangent with its sign.
struct RestFrame {
    Vec3 normal = {0, 0, 1};
    Vec4 tangent = {1, 0, 0, 1};
};
RestFrame rest_frame(const MeshData& mesh, std::size_t v) {
    const auto at = [v](const auto& values, const auto& fallback) {
        return v < values.size() ? values[v] : fallback;
    };
    const Vec3 n = normalize_or(at(mesh.normals, Vec3(0, 0, 1)), {0, 0, 1});
    const Vec4 t = at(mesh.tangents, Vec4(any_perpendicular(n), 1));
    return {n, Vec4(normalize_or(Vec3(t), any_perpendicular(n)), t.w < 0 ? -1.0f : 1.0f)};
}

/// The influences of all vertices; `first` receives the start of each vertex's list, plus the end.
Texels
influence_texels(const SkinWeights& skin, std::size_t vertices, std::vector<std::size_t>& first) {
    Texels texels;
    for (std::size_t v = 0; v < vertices; ++v) {
        first.push_back(texels.size());
        const std::uint32_t end = skin.empty() ? 0 : skin.first[v + 1];
        for (std::uint32_t i = skin.empty() ? 0 : skin.first[v]; i < end; i += 2) {
            // An odd last influence is paired with weight 0.
            const bool alone = i + 1 == end;
            texels.push_back(
                {skin.joints[i], bits_of(skin.weights[i]), skin.joints[alone ? i : i + 1],
                 alone ? 0 : bits_of(skin.weights[i + 1])});
        }
    }
    first.push_back(texels.size());
    return texels;
}

/// The same, each in the space of its joint: o = M^-1 v, N = R^-1 n (char.skin-vertex-offset).
Texels
joint_offset_texels(const MeshData& mesh, const SkinData& skin, std::vector<std::size_t>& first) {
    Texels texels;
    const SkinWeights& by = mesh.skin;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        first.push_back(texels.size());
        const RestFrame frame = rest_frame(mesh, v);
        for (std::uint32_t i = by.first[v]; i < by.first[v + 1]; ++i) {
            const Affine& joint_from_mesh = skin.joint_from_mesh[by.joints[i]];
            const Vec3 p = transform_point(joint_from_mesh, mesh.positions[v]);
            const Vec3 n = transform_vector(joint_from_mesh, frame.normal);
            const Vec3 t = transform_vector(joint_from_mesh, Vec3(frame.tangent));
            texels.push_back({bits_of(p.x), bits_of(p.y), bits_of(p.z), bits_of(by.weights[i])});
            texels.push_back({bits_of(n.x), bits_of(n.y), bits_of(n.z), by.joints[i]});
            texels.push_back({bits_of(t.x), bits_of(t.y), bits_of(t.z), 0});
        }
    }
    first.push_back(texels.size());
    return texels;
}

Texels offset_texels(const MeshData& mesh, std::vector<std::size_t>& first) {
    Texels texels;
    const auto at = [](const std::vector<Vec3>& offsets, std::size_t i) {
        return offsets.empty() ? Vec3(0) : offsets[i];
    };
    for (const std::vector<Offset>& offsets : offsets_of_vertices(mesh)) {
        first.push_back(texels.size());
        for (const Offset& offset : offsets) {
            const MorphTarget& target = mesh.morphs[offset.target];
            const Vec3 p = target.positions[offset.entry];
            const Vec3 n = at(target.normals, offset.entry);
            const Vec3 t = at(target.tangents, offset.entry);
            texels.push_back({bits_of(p.x), bits_of(p.y), bits_of(p.z), offset.target});
            texels.push_back({pack_snorm(n.x, n.y), pack_snorm(n.z, t.x), pack_snorm(t.y, t.z), 0});
        }
    }
    first.push_back(texels.size());
    return texels;
}

Texels anchor_texels(std::span<const SurfaceAnchor> anchors) {
    Texels texels;
    for (const SurfaceAnchor& at : anchors) {
        texels.push_back({at.patch, bits_of(at.u), bits_of(at.v), bits_of(at.offset.x)});
        texels.push_back(
            {bits_of(at.offset.y), bits_of(at.offset.z), bits_of(at.normal.x),
             bits_of(at.normal.y)});
        texels.push_back(
            {bits_of(at.normal.z), bits_of(at.tangent.x), bits_of(at.tangent.y),
             bits_of(at.tangent.z)});
        texels.push_back({bits_of(at.share), at.next, 0, 0});
    }
    return texels;
}

}  // namespace

const RestMesh&
RestPool::get(const Assets& assets, MeshId mesh, std::span<const SurfaceAnchor> anchors) {
    meshes_.resize(std::max<std::size_t>(meshes_.size(), mesh.index + 1));
    std::optional<RestMesh>& made = meshes_[mesh.index];
    if (!made || made->version != assets.meshes[mesh.index].version
        || (!anchors.empty() && !made->has_anchors)) {
        if (made) {
            release(*made);
        }
        made = upload(assets.meshes[mesh.index], anchors, nullptr);
    }
    return *made;
}

const RestMesh& RestPool::get_joint_offsets(const Assets& assets, MeshId mesh, SkinId skin) {
    const auto [found, is_new] = joint_offsets_.try_emplace({mesh.index, skin.index});
    RestMesh& made = found->second;
    const MeshData& data = assets.meshes[mesh.index];
    if (is_new || made.version != data.version) {
        const SkinData& bind = assets.skins[skin.index];
        release(made);
        made = upload(data, {}, &bind);
        for (SkinBounds::Joint& one : made.bounds.joints) {
            one.box = transform_bounds(bind.joint_from_mesh[one.joint], one.box);
        }
    }
    return made;
}

void RestPool::release(const RestMesh& mesh) {
    if (mesh.texel_count > 0) {
        slots_.release(mesh.first_texel, mesh.texel_count);
    }
}

RestMesh RestPool::upload(
    const MeshData& mesh, std::span<const SurfaceAnchor> anchors, const SkinData* skin) {
    RestMesh made;
    made.version = mesh.version;
    made.fault = check_deformable(mesh);
    if (!made.fault.empty()) {
        return made;
    }
    made.bounds = make_skin_bounds(mesh);
    made.vertex_count = static_cast<std::uint32_t>(mesh.positions.size());
    made.joint_count = made.bounds.joints.empty() ? 0u : made.bounds.joints.back().joint + 1u;

    std::vector<std::size_t> first_influence;
    std::vector<std::size_t> first_offset;
    const Texels influences =
        skin != nullptr ? joint_offset_texels(mesh, *skin, first_influence)
                        : influence_texels(mesh.skin, mesh.positions.size(), first_influence);
    const Texels offsets = offset_texels(mesh, first_offset);
    made.has_anchors = !anchors.empty() && anchors.size() >= mesh.positions.size();
    const Texels anchored = made.has_anchors ? anchor_texels(anchors) : Texels{};
    const std::size_t anchors_at = layout::kRestTexels * (mesh.positions.size() + 1);
    const std::size_t influences_at = anchors_at + anchored.size();
    const std::size_t offsets_at = influences_at + influences.size();

    Texels texels;
    texels.reserve(offsets_at + offsets.size());
    for (std::size_t v = 0; v <= mesh.positions.size(); ++v) {
        const Vec3 p = v < mesh.positions.size() ? mesh.positions[v] : Vec3(0);
        const auto [n, t] = rest_frame(mesh, v);
        const auto influence = static_cast<layout::uint>(influences_at + first_influence[v]);
        const auto offset = static_cast<layout::uint>(offsets_at + first_offset[v]);
        texels.push_back({bits_of(p.x), bits_of(p.y), bits_of(p.z), influence});
        texels.push_back({bits_of(n.x), bits_of(n.y), bits_of(n.z), offset});
        texels.push_back({bits_of(t.x), bits_of(t.y), bits_of(t.z), bits_of(t.w)});
    }
    texels.insert(texels.end(), anchored.begin(), anchored.end());
    texels.insert(texels.end(), influences.begin(), influences.end());
    texels.insert(texels.end(), offsets.begin(), offsets.end());

    made.texel_count = static_cast<std::uint32_t>(texels.size());
    const std::uint32_t old = slots_.capacity();
    made.first_texel = slots_.allocate_or_grow(made.texel_count, kInitialRestTexels);
    if (slots_.capacity() > old) {
        buffer_ = gpu::grown_buffer(
            "meshes at rest", buffer_, old * kTexelBytes, slots_.capacity() * kTexelBytes);
    }
    buffer_.write(made.first_texel * kTexelBytes, std::span<const layout::uvec4>(texels));
    return made;
}

void RestPool::clear() {
    meshes_.clear();
    joint_offsets_.clear();
    slots_.clear();
}

}  // namespace limn
