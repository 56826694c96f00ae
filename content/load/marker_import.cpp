#include "content/load/marker_import.h"

#include "content/bake/tangents.h"
#include "content/load/json_document.h"
#include "content/load/marker_file.h"
#include "ecs/base/text.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <numeric>
#include <utility>

namespace limn {
namespace {

using DVec2 = glm::dvec2;
using Corners = std::array<std::size_t, 3>;

double turn_of(const DVec2& a, const DVec2& b, const DVec2& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Whether d is within the circle through a, b and c, which turn counter-clockwise.
bool is_in_circle(const DVec2& a, const DVec2& b, const DVec2& c, const DVec2& d) {
    const DVec2 p = a - d;
    const DVec2 q = b - d;
    const DVec2 r = c - d;
    return glm::dot(p, p) * (q.x * r.y - q.y * r.x) - glm::dot(q, q) * (p.x * r.y - p.y * r.x)
               + glm::dot(r, r) * (p.x * q.y - p.y * q.x)
           > 0.0;
}

/// Angle around a vertical axis, times the radius, and height. The axis lies as far behind the
/// middle as the face is wide.
std::vector<DVec2> unroll(std::span<const Vec3> positions) {
    Bounds box;
    for (const Vec3& p : positions) {
        grow(box, p);
    }
    const Vec3 middle = center(box);
    const double radius =
        static_cast<double>(std::max({half_extent(box).x, half_extent(box).z, 1e-3f})) * 2.0;
    std::vector<DVec2> flat;
    for (const Vec3& p : positions) {
        const double angle = std::atan2(
            static_cast<double>(p.x - middle.x), static_cast<double>(p.z - middle.z) + radius);
        flat.emplace_back(radius * angle, p.y);
    }
    return flat;
}

bool is_head(const std::string& name) {
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

MeshData make_surface(std::span<const Vec3> rest) {
    MeshData mesh;
    mesh.name = "markers";
    mesh.positions.assign(rest.begin(), rest.end());
    mesh.uvs.assign(rest.size(), Vec2(0));
    mesh.indices = triangulate_markers(rest);
    for (std::size_t m = 0; m < rest.size(); ++m) {
        mesh.skin.first.push_back(static_cast<std::uint32_t>(m));
        mesh.skin.joints.push_back(static_cast<std::uint16_t>(m));
        mesh.skin.weights.push_back(1.0f);
    }
    mesh.skin.first.push_back(static_cast<std::uint32_t>(rest.size()));
    generate_normals(mesh);
    update_bounds(mesh);
    return mesh;
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

}  // namespace

std::vector<std::uint32_t> triangulate_markers(std::span<const Vec3> positions) {
    std::vector<DVec2> flat = unroll(positions);
    const std::size_t count = flat.size();
    double size = 1e-6;
    for (const DVec2& p : flat) {
        size = std::max(size, glm::distance(p, flat[0]));
    }
    // A triangle around all, far enough that it hardly bends the hull.
    const DVec2 middle = flat.empty() ? DVec2(0) : flat[0];
    flat.push_back(middle + 1e4 * size * DVec2(-1, -1));
    flat.push_back(middle + 1e4 * size * DVec2(1, -1));
    flat.push_back(middle + 1e4 * size * DVec2(0, 1));
    std::vector<Corners> triangles = {{count, count + 1, count + 2}};
    for (std::size_t i = 0; i < count; ++i) {
        const bool is_twin = std::any_of(
            flat.begin(), flat.begin() + static_cast<std::ptrdiff_t>(i),
            [&](const DVec2& p) { return p == flat[i]; });
        if (is_twin) {
            continue;
        }
        std::map<std::pair<std::size_t, std::size_t>, int> edges;  // of what is taken out
        std::erase_if(triangles, [&](const Corners& t) {
            const bool out = is_in_circle(flat[t[0]], flat[t[1]], flat[t[2]], flat[i]);
            for (std::size_t k = 0; out && k < 3; ++k) {
                ++edges[{t[k], t[(k + 1) % 3]}];
            }
            return out;
        });
        for (const auto& [edge, times] : edges) {
            if (!edges.contains({edge.second, edge.first})) {
                triangles.push_back({edge.first, edge.second, i});
            }
        }
    }
    std::vector<std::uint32_t> indices;
    for (const Corners& t : triangles) {
        if (std::max({t[0], t[1], t[2]}) < count
            && turn_of(flat[t[0]], flat[t[1]], flat[t[2]]) > 1e-9 * size * size) {
            for (const std::size_t corner : t) {
                indices.push_back(static_cast<std::uint32_t>(corner));
            }
        }
    }
    return indices;
}

Result<GltfScene> make_marker_scene(const std::string& name, MarkerMotion motion) {
    std::vector<std::uint32_t> head;
    for (std::uint32_t m = 0; m < motion.markers(); ++m) {
        if (!is_finite(motion.positions[m])) {
            return fail(
                "{}: the first frame, the face at rest, lacks the marker {}", name,
                in_quotes(motion.names[m]));
        }
        if (is_head(motion.names[m])) {
            head.push_back(m);
        }
    }
    const std::vector<Vec3> rest(
        motion.positions.begin(),
        motion.positions.begin() + static_cast<std::ptrdiff_t>(motion.markers()));
    if (!head.empty()) {
        const Result<std::vector<Affine>> heads = stabilize_head(motion, rest, head);
        if (!heads) {
            return fail("{}: {}", name, heads.error().message);
        }
    }
    MarkerMotion face = face_of(motion, head);
    const std::vector<Vec3> places(
        face.positions.begin(),
        face.positions.begin() + static_cast<std::ptrdiff_t>(face.markers()));
    if (face.markers() > 65000) {
        return fail("{}: found {} markers, expected at most 65000", name, face.markers());
    }
    fill_gaps(face, places);

    GltfScene scene;
    scene.name = name;
    MeshData surface = make_surface(places);
    if (surface.indices.empty()) {
        return fail("{}: found no three markers of the face that span a triangle", name);
    }
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
    for (std::size_t m = 0; m < places.size(); ++m) {
        const auto joint = static_cast<std::uint16_t>(m + 1);
        GltfNode& node = scene.nodes.emplace_back();
        node.name = face.names[m];
        node.transform.position = places[m];
        scene.joints.push_back(joint);
        scene.skeleton.joints.push_back(face.names[m]);
        scene.skeleton.parents.push_back(0);
        scene.skeleton.rest.translations.push_back(places[m]);
        skin.joints.push_back(joint);
        skin.joint_from_mesh.push_back(affine_from(-places[m], Quat(1, 0, 0, 0), Vec3(1)));
    }
    scene.skeleton.rest.rotations.assign(places.size() + 1, Quat(1, 0, 0, 0));
    scene.skeleton.rest.scales.assign(places.size() + 1, Vec3(1));
    scene.skins.push_back(std::move(skin));
    scene.meshes.push_back(std::move(surface));
    scene.materials.push_back(
        {.name = "unseen", .alpha_mode = AlphaMode::Blend, .base_color = Vec4(0)});
    scene.clips.push_back(make_clip(face));
    return scene;
}

Result<GltfScene> import_markers(const std::string& in) {
    MarkerMotion motion = LIMN_TRY(load_trc(in));
    return make_marker_scene(std::filesystem::path(in).stem().string(), std::move(motion));
}

}  // namespace limn
