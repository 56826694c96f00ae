#include "content/load/faces/marker_import.h"

#include "content/bake/delaunay.h"
#include "content/bake/tangents.h"
#include "content/load/faces/marker_file.h"
#include "content/load/files/json_document.h"
#include "content/make/head/head.h"
#include "content/make/head/head_markers.h"
#include "ecs/base/text.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <numeric>
#include <string_view>
#include <utility>

// Techniques: face.head-stabilise, face.mocap-drive

namespace limn {
namespace {

using DVec2 = glm::dvec2;

/// Unrolled around a vertical axis: angle times radius, and height. The axis is as far behind the
/// center as the face is wide.
std::vector<DVec2> unroll(std::span<const Vec3> positions) {
    Bounds box;
    for (const Vec3& p : positions) {
        grow(box, p);
    }
    const Vec3 origin = center(box);
    const double radius =
        static_cast<double>(std::max({half_extent(box).x, half_extent(box).z, 1e-3f})) * 2.0;
    std::vector<DVec2> flat;
    for (const Vec3& p : positions) {
        const double angle = std::atan2(
            static_cast<double>(p.x - origin.x), static_cast<double>(p.z - origin.z) + radius);
        flat.emplace_back(radius * angle, p.y);
    }
    return flat;
}

bool is_head_marker(const std::string& name) {
    std::string start = name.substr(0, 4);
    std::transform(start.begin(), start.end(), start.begin(), [](char c) {
        return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    });
    return start == "head";
}

/// The recording without its markers `head`.
MarkerMotion face_of(const MarkerMotion& motion, const std::vector<std::uint32_t>& head) {
    MarkerMotion face;
    face.rate = motion.rate;
    for (std::uint32_t m = 0; m < motion.markers(); ++m) {
        if (std::find(head.begin(), head.end(), m) == head.end()) {
            face.names.push_back(motion.names[m]);
        }
    }
    for (std::size_t i = 0; i < motion.positions.size(); ++i) {
        const auto m = static_cast<std::uint32_t>(i % motion.markers());
        if (std::find(head.begin(), head.end(), m) == head.end()) {
            face.positions.push_back(motion.positions[i]);
        }
    }
    return face;
}

/// Each vertex with the joint of its marker.
SkinWeights one_joint_each(std::span<const std::uint16_t> joints) {
    SkinWeights skin;
    for (std::size_t v = 0; v < joints.size(); ++v) {
        skin.first.push_back(static_cast<std::uint32_t>(v));
        skin.joints.push_back(joints[v]);
        skin.weights.push_back(1.0f);
    }
    skin.first.push_back(static_cast<std::uint32_t>(joints.size()));
    return skin;
}

MeshData make_surface(std::span<const Vec3> rest) {
    MeshData mesh;
    mesh.name = "markers";
    mesh.positions.assign(rest.begin(), rest.end());
    mesh.uvs.assign(rest.size(), Vec2(0));
    mesh.indices = triangulate_markers(rest);
    std::vector<std::uint16_t> joints(rest.size());
    std::iota(joints.begin(), joints.end(), std::uint16_t{0});
    mesh.skin = one_joint_each(joints);
    generate_normals(mesh);
    update_bounds(mesh);
    return mesh;
}

/// The recording of a face without the motion of its head, and its rest pose.
struct Take {
    MarkerMotion face;
    std::vector<Vec3> rest;
};

Result<Take> make_take(const std::string& name, MarkerMotion motion) {
    std::vector<std::uint32_t> head;
    for (std::uint32_t m = 0; m < motion.markers(); ++m) {
        if (!is_finite(motion.positions[m])) {
            return fail(
                "{}: the first frame, the face at rest, lacks the marker {}", name,
                in_quotes(motion.names[m]));
        }
        if (is_head_marker(motion.names[m])) {
            head.push_back(m);
        }
    }
    const auto first_frame = [](const MarkerMotion& of) {
        const auto end = of.positions.begin() + static_cast<std::ptrdiff_t>(of.markers());
        return std::vector<Vec3>(of.positions.begin(), end);
    };
    if (!head.empty()) {
        const Result<std::vector<Affine>> heads = stabilize_head(motion, first_frame(motion), head);
        if (!heads) {
            return fail("{}: {}", name, heads.error().message);
        }
    }
    Take take{face_of(motion, head), {}};
    take.rest = first_frame(take.face);
    if (take.face.markers() > 65000) {
        return fail("{}: found {} markers, expected at most 65000", name, take.face.markers());
    }
    return take;
}

ClipData make_clip(const MarkerMotion& face) {
    ClipSheet sheet;
    for (std::size_t f = 0; f < face.frames(); ++f) {
        sheet.times.push_back(static_cast<float>(f) / face.rate);
    }
    for (std::size_t m = 0; m < face.markers(); ++m) {
        sheet.translating.push_back(static_cast<std::uint16_t>(m + 1));
    }
    sheet.translations = face.positions;
    ClipData clip;
    clip.name = "take";
    clip.duration = sheet.times.back();
    clip.sheets.push_back(std::move(sheet));
    return clip;
}

/// Adds the markers as joints of the skin of `surface`, which already has their influences.
GltfScene make_scene(const std::string& name, const Take& take, MeshData surface) {
    const MarkerMotion& face = take.face;
    const std::vector<Vec3>& rest = take.rest;
    GltfScene scene;
    scene.name = name;
    scene.skeleton.joints.push_back(name);
    scene.skeleton.parents.push_back(-1);
    scene.skeleton.rest.translations.emplace_back(0);
    SkinData skin;
    skin.name = "markers";
    GltfNode& root = scene.nodes.emplace_back();
    root.name = name;
    root.parts.push_back({0, 0});
    root.skin = 0;
    scene.joints.push_back(-1);
    for (std::size_t m = 0; m < rest.size(); ++m) {
        const auto joint = static_cast<std::uint16_t>(m + 1);
        GltfNode& node = scene.nodes.emplace_back();
        node.name = face.names[m];
        node.transform.position = rest[m];
        scene.joints.push_back(joint);
        scene.skeleton.joints.push_back(face.names[m]);
        scene.skeleton.parents.push_back(0);
        scene.skeleton.rest.translations.push_back(rest[m]);
        skin.joints.push_back(joint);
        skin.joint_from_mesh.push_back(affine_from(-rest[m], Quat(1, 0, 0, 0), Vec3(1)));
    }
    scene.skeleton.rest.rotations.assign(rest.size() + 1, Quat(1, 0, 0, 0));
    scene.skeleton.rest.scales.assign(rest.size() + 1, Vec3(1));
    scene.skins.push_back(std::move(skin));
    scene.meshes.push_back(std::move(surface));
    scene.materials.push_back(
        {.name = "unseen", .alpha_mode = AlphaMode::Mask, .base_color = Vec4(0)});
    scene.clips.push_back(make_clip(face));
    return scene;
}

}  // namespace

std::vector<std::uint32_t> triangulate_markers(std::span<const Vec3> positions) {
    return triangulate_points(unroll(positions));
}

Result<MarkerMotion> isolate_face(const std::string& name, MarkerMotion motion) {
    Take take = LIMN_TRY(make_take(name, std::move(motion)));
    fill_gaps(take.face, take.rest);
    if (take.face.markers() < 3) {
        return fail("{}: found {} markers of the face, expected three", name, take.face.markers());
    }
    return std::move(take.face);
}

Result<GltfScene> make_marker_scene(const std::string& name, MarkerMotion motion) {
    Take take = LIMN_TRY(make_take(name, std::move(motion)));
    fill_gaps(take.face, take.rest);
    MeshData surface = make_surface(take.rest);
    if (surface.indices.empty()) {
        return fail("{}: found no three markers of the face that span a triangle", name);
    }
    return make_scene(name, take, std::move(surface));
}

Result<GltfScene>
make_marker_scene(const std::string& name, MarkerMotion motion, const MarkerSurface& surface) {
    const Take take = LIMN_TRY(make_take(name, std::move(motion)));
    Take known;
    known.face.rate = take.face.rate;
    std::map<std::string, std::uint16_t> joint_of;
    std::vector<std::uint16_t> joints;
    for (std::size_t v = 0; v < surface.names.size(); ++v) {
        const auto next = static_cast<std::uint16_t>(joint_of.size());
        const auto [joint, is_new] = joint_of.try_emplace(surface.names[v], next);
        if (is_new) {
            known.face.names.push_back(surface.names[v]);
            known.rest.push_back(surface.mesh.positions[v]);
        }
        joints.push_back(joint->second);
    }
    const std::size_t count = known.rest.size();
    const Vec3 unseen(std::numeric_limits<float>::quiet_NaN());
    known.face.positions.assign(take.face.frames() * count, unseen);
    for (std::size_t m = 0; m < take.face.markers(); ++m) {
        const auto found = joint_of.find(take.face.names[m]);
        if (found == joint_of.end()) {
            const std::vector<std::string_view> names(
                known.face.names.begin(), known.face.names.end());
            return fail(
                "{}: the surface has no marker {}{}", name, in_quotes(take.face.names[m]),
                did_you_mean(take.face.names[m], names));
        }
        for (std::size_t f = 0; f < take.face.frames(); ++f) {
            const Vec3 moved = take.face.positions[f * take.face.markers() + m] - take.rest[m];
            known.face.positions[f * count + found->second] = known.rest[found->second] + moved;
        }
    }
    fill_gaps(known.face, known.rest);
    MeshData mesh = surface.mesh;
    mesh.morphs.clear();
    mesh.skin = one_joint_each(joints);
    return make_scene(name, known, std::move(mesh));
}

Result<GltfScene> import_markers(const std::string& in, const MarkerSurface* surface) {
    MarkerMotion motion = LIMN_TRY(load_trc(in));
    const std::string name = std::filesystem::path(in).stem().string();
    return surface != nullptr ? make_marker_scene(name, std::move(motion), *surface)
                              : make_marker_scene(name, std::move(motion));
}

MarkerSurface make_head_marker_surface() {
    return {make_head({.part = HeadPartKind::Markers}), head_markers().names};
}

}  // namespace limn
