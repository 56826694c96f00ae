#include "content/load/faces/marker_import.h"
#include "content/load/gltf/gltf_load.h"
#include "content/load/gltf/gltf_write.h"
#include "content/make/head/head.h"
#include "content/make/head/head_expressions.h"
#include "content/make/head/head_layout.h"
#include "content/make/head/head_markers.h"
#include "ecs/components/animation.h"
#include "ecs/components/surface.h"
#include "ecs/components/surface_binding.h"
#include "ecs/world.h"
#include "systems/animation/patch_kernels.h"
#include "systems/animation/patch_normals.h"
#include "systems/animation/pose_system.h"
#include "systems/animation/skin_kernels.h"
#include "systems/animation/surface_binding_system.h"
#include "systems/animation/surface_patches.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace limn::head_markers_test {
namespace {

const HeadVertex& layout_vertex(std::uint32_t marker) {
    return head_layout().vertices[head_markers().vertices[marker]];
}

/// The side of a marker of the mouth relative to where the lips touch; 0: at its corners, or
/// elsewhere.
int lip_of(std::uint32_t marker) {
    const HeadVertex& vertex = layout_vertex(marker);
    const float up = std::sin(vertex.angle);
    return vertex.loops != HeadLoops::Mouth || std::abs(up) < 1e-3f ? 0 : up > 0 ? 1 : -1;
}

const MeshData& surface() {
    static const MeshData made = make_head({.part = HeadPartKind::Markers});
    return made;
}

const MeshData& skin() {
    static const MeshData made = make_head({});
    return made;
}

/// A mouth that opens wide and smiles, at this weight.
std::vector<Vec3> laugh(const MeshData& mesh, float weight) {
    std::vector<float> weights(mesh.morphs.size(), 0.0f);
    for (const std::string_view unit : {"AU27", "AU25", "AU12_L", "AU12_R", "AU45_L"}) {
        weights[expression_index(unit)] = weight;
    }
    std::vector<Vec3> positions = mesh.positions;
    add_morphs(mesh.morphs, weights, {positions, {}, {}});
    return positions;
}

constexpr int kFrames = 5;

/// A recording of the markers while the head nods, as a TRC file without markers whose names begin
/// with `lacks`.
std::string record_laugh(std::string_view lacks) {
    std::map<std::string, std::size_t> markers;  // by name, a vertex each
    for (std::size_t v = 0; v < surface().positions.size(); ++v) {
        const std::string& name = head_markers().names[v];
        if (lacks.empty() || !name.starts_with(lacks)) {
            markers[name] = v;
        }
    }
    constexpr std::array<Vec3, 4> kHead = {
        {{-0.08f, 0.15f, 0}, {0.08f, 0.15f, 0}, {0, 0.2f, 0}, {0, 0.15f, 0.1f}}};
    std::string text = "PathFileType\t4\t(X/Y/Z)\tlaugh.trc\nDataRate\tUnits\n60\tmm\nFrame#\tTime";
    for (std::size_t i = 0; i < kHead.size(); ++i) {
        text += fmt::format("\thead{}\t\t", i);
    }
    for (const auto& marker : markers) {
        text += fmt::format("\t{}\t\t", marker.first);
    }
    text += "\n\t\tX1\n";
    for (int f = 0; f < kFrames; ++f) {
        const float time = static_cast<float>(f) / (kFrames - 1);
        const std::vector<Vec3> shape = laugh(surface(), time);
        const Affine nod =
            affine_from({0, 0.02f * time, 0}, glm::angleAxis(0.3f * time, Vec3(1, 0, 0)), Vec3(1));
        text += fmt::format("{}\t0", f + 1);
        const auto add = [&](const Vec3& position) {
            const Vec3 p = 1000.0f * transform_point(nod, position);
            text += fmt::format("\t{:.5f}\t{:.5f}\t{:.5f}", p.x, p.y, p.z);
        };
        for (const Vec3& position : kHead) {
            add(position);
        }
        for (const auto& marker : markers) {
            add(shape[marker.second]);
        }
        text += "\n";
    }
    return text;
}

/// `head` at the end of a recording: imported, written, read and followed.
std::vector<Vec3> perform(const std::string& recording, const MeshData& head = skin()) {
    const std::filesystem::path folder = std::filesystem::temp_directory_path();
    const std::string trc = (folder / "limn_laugh.trc").string();
    const std::string glb = (folder / "limn_laugh.glb").string();
    std::ofstream(trc) << recording;
    const MarkerSurface known = make_head_marker_surface();
    const Result<GltfScene> made = import_markers(trc, &known);
    REQUIRE_MESSAGE(made.ok(), (made ? std::string() : made.error().message));
    REQUIRE(save_glb(glb, *made).ok());
    const GltfScene take = *load_gltf(glb);
    std::filesystem::remove(trc);
    std::filesystem::remove(glb);
    World world;
    auto& assets = world.insert_resource(Assets{});
    assets.meshes = {head, take.meshes[0]};
    assets.skeletons = {take.skeleton};
    assets.skins = take.skins;
    assets.clips = take.clips;
    const Entity character = world.create(Skeleton{{0}}, ClipPlayer{{0}, take.clips[0].duration});
    Deformed deformed;
    deformed.character = character;
    deformed.skin = {0};
    world.create(MeshInstance{{1}, {}}, deformed);
    SurfaceBinding binding;
    binding.surface = character;
    binding.method = SurfaceMethod::Patches;
    binding.by_uvs = true;
    binding.reach = 0.1f;
    const Entity face = world.create(MeshInstance{{0}, {}}, binding);
    world.run(add_poses);
    world.run(add_surface_binding_states);
    world.run(bind_surfaces);
    world.run(update_poses);
    world.run(update_surface_bindings);
    const auto& state = world.get<SurfaceBindingState>(face);
    REQUIRE(state.anchors != nullptr);
    std::vector<Vec3> positions = head.positions;
    move_by_patches(surface_shape(&state, state.patches), positions);
    return positions;
}

float rms(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    float sum = 0;
    for (std::size_t v = 0; v < a.size(); ++v) {
        sum += glm::dot(a[v] - b[v], a[v] - b[v]);
    }
    return std::sqrt(sum / static_cast<float>(a.size()));
}

/// Distance between the centers of the lips [m].
float gap(const std::vector<Vec3>& positions) {
    float upper = INFINITY;
    float lower = INFINITY;
    std::size_t at_upper = 0;
    std::size_t at_lower = 0;
    for (std::size_t m = 0; m < surface().positions.size(); ++m) {
        for (std::size_t v = 0; v < positions.size(); ++v) {
            const float to = glm::distance(skin().uvs[v], surface().uvs[m]);
            if (head_markers().names[m] == "mouth11_90_M" && to < upper) {
                upper = to;
                at_upper = v;
            }
            if (head_markers().names[m] == "mouth11_270_M" && to < lower) {
                lower = to;
                at_lower = v;
            }
        }
    }
    return glm::distance(positions[at_upper], positions[at_lower]);
}

}  // namespace

TEST_CASE(
    "head markers: triangles are a surface with one border, the end of the neck"
    * technique("face.bids-surface")) {
    const HeadMarkers& markers = head_markers();
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    double area = 0;
    for (std::size_t i = 0; i < markers.indices.size(); i += 3) {
        std::array<Vec2, 3> at{};
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = markers.indices[i + k];
            const std::uint32_t b = markers.indices[i + (k + 1) % 3];
            CHECK(edges.insert({a, b}).second);
            at[k] = markers.charts[a];
        }
        const Vec2 p = at[1] - at[0];
        const Vec2 q = at[2] - at[0];
        CHECK(p.x * q.y < p.y * q.x);  // rows run down
        area += 0.5 * static_cast<double>(p.y * q.x - p.x * q.y);
    }
    // Their convex hull: the grid, and on either side a triangle below the center of the crown.
    CHECK(area == test::near(kHeadColumns * kHeadRows + 2 * 0.5 * 48 * 12));
    for (const auto& [a, b] : edges) {
        if (!edges.contains({b, a})) {
            const bool seam =
                std::abs(markers.charts[a].x) == 48 && std::abs(markers.charts[b].x) == 48;
            const bool neck = markers.charts[a].y == kHeadRows && markers.charts[b].y == kHeadRows;
            const bool crown = markers.charts[a].y == -12 || markers.charts[b].y == -12;
            CHECK((seam || neck || crown));
        }
    }
}

TEST_CASE(
    "head markers: their surface has no creases but where the markers themselves fold back"
    * technique("face.bids-surface")) {
    const MeshData& mesh = surface();
    std::map<std::string, std::uint64_t> kind_of;
    std::vector<std::uint64_t> kinds;
    for (const std::string& name : head_markers().names) {
        kinds.push_back(kind_of.try_emplace(name, kind_of.size()).first->second);
    }
    const auto faces = make_patch_faces(mesh.positions, mesh.indices, kinds);
    REQUIRE(faces);
    const std::vector<std::uint32_t>& corners = faces->corners;
    std::vector<Vec4> patches;
    make_patches(mesh.positions, corners, patches);
    std::vector<Vec3> normals;
    make_patch_normals(mesh.positions, corners, normals);
    std::vector<std::vector<Vec3>> around(mesh.positions.size());
    std::vector<Vec3> areas;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> first;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec3& a = mesh.positions[corners[i / 3 * 3]];
        areas.push_back(glm::cross(
            mesh.positions[corners[i / 3 * 3 + 1]] - a,
            mesh.positions[corners[i / 3 * 3 + 2]] - a));
        around[corners[i]].push_back(glm::normalize(areas[i]));
        first[{corners[i], corners[i % 3 == 2 ? i - 2 : i + 1]}] = i;
    }
    const auto has_plane = [&](std::uint32_t marker) {
        const Vec3 axis = axis_of_cone(around[marker]);
        return std::ranges::all_of(
            around[marker], [&](const Vec3& normal) { return glm::dot(normal, axis) > 0.15f; });
    };
    const auto geometric_normal = [&](std::size_t corner, float share) {
        Vec3 weights(0);
        weights[static_cast<int>(corner % 3)] = 1.0f - share;
        weights[static_cast<int>((corner + 1) % 3)] = share;
        const PatchPoint at = evaluate_patch(
            std::span(patches).subspan(corner / 3 * kPatchTexels, kPatchTexels), weights.x,
            weights.y);
        return glm::normalize(glm::cross(at.by_u, at.by_v));
    };
    float largest = 0;
    int smooth = 0;
    int folded = 0;
    for (const auto& [ends, i] : first) {
        const auto other = first.find({ends.second, ends.first});
        if (ends.first > ends.second || other == first.end()) {
            continue;
        }
        const std::size_t j = other->second;
        const bool faces_along = glm::dot(areas[i], normals[ends.first]) > 0
                                 && glm::dot(areas[i], normals[ends.second]) > 0
                                 && glm::dot(areas[j], normals[ends.first]) > 0
                                 && glm::dot(areas[j], normals[ends.second]) > 0;
        ++(faces_along ? smooth : folded);
        CHECK((faces_along || !has_plane(ends.first) || !has_plane(ends.second)));
        for (int k = 0; k <= 32 && faces_along; ++k) {
            const float t = static_cast<float>(k) / 32.0f;
            const Vec3 n = geometric_normal(i, t);
            const Vec3 m = geometric_normal(j, 1.0f - t);
            largest = std::max(
                largest, glm::degrees(std::atan2(glm::length(glm::cross(n, m)), glm::dot(n, m))));
        }
    }
    CHECK(largest <= 0.1f);
    CHECK(smooth == 1069);
    CHECK(folded == 20);  // in the corners of the mouth, where lips touch
}

TEST_CASE(
    "head markers: each lip and each lid has its own, and no triangle spans an opening"
    * technique("face.bids-project")) {
    const HeadMarkers& markers = head_markers();
    int upper = 0;
    int lower = 0;
    for (std::uint32_t m = 0; m < markers.names.size(); ++m) {
        const HeadVertex& vertex = layout_vertex(m);
        if (vertex.loops == HeadLoops::Mouth && vertex.loop == kLipLoop) {
            upper += lip_of(m) > 0 ? 1 : 0;
            lower += lip_of(m) < 0 ? 1 : 0;
        }
    }
    CHECK(upper >= 5);
    CHECK(lower == upper);
    for (std::size_t i = 0; i < markers.indices.size(); i += 3) {
        const auto at = [&](std::size_t k) -> const HeadVertex& {
            return layout_vertex(markers.indices[i + k]);
        };
        bool up = false;
        bool down = false;
        bool before = true;  // not within the mouth or behind the lids
        for (std::size_t k = 0; k < 3; ++k) {
            const HeadVertex& vertex = at(k);
            const bool opening = vertex.loops == HeadLoops::Mouth || vertex.loops == HeadLoops::Eye;
            const int last = vertex.loops == HeadLoops::Mouth ? kLipLoop + 2 : kLidLoop;
            before = before && opening && vertex.loop <= last;
            up = up || std::sin(vertex.angle) > 1e-3f;
            down = down || std::sin(vertex.angle) < -1e-3f;
        }
        if (before && up && down) {  // around a corner, which one of the three is
            const bool corner = std::abs(std::sin(at(0).angle)) < 1e-3f
                                || std::abs(std::sin(at(1).angle)) < 1e-3f
                                || std::abs(std::sin(at(2).angle)) < 1e-3f;
            CHECK(corner);
        }
    }
}

TEST_CASE("head markers: they are vertices of the skin, and mirror images of each other") {
    const MeshData& head = skin();
    const MeshData& coarse = surface();
    REQUIRE(coarse.positions.size() == head_markers().names.size());
    REQUIRE(coarse.morphs.size() == head.morphs.size());
    std::map<std::pair<float, float>, std::uint32_t> by_uv;
    for (std::uint32_t v = 0; v < head.positions.size(); ++v) {
        by_uv[{head.uvs[v].x, head.uvs[v].y}] = v;
    }
    std::map<std::string, Vec3> positions;
    for (std::size_t m = 0; m < coarse.positions.size(); ++m) {
        const auto found = by_uv.find({coarse.uvs[m].x, coarse.uvs[m].y});
        if (head_markers().charts[m].y != -12) {
            REQUIRE(found != by_uv.end());
            CHECK(coarse.positions[m] == head.positions[found->second]);
        }
        positions[head_markers().names[m]] = coarse.positions[m];
    }
    int pairs = 0;
    for (const auto& [name, position] : positions) {
        if (name.ends_with("_L")) {
            const Vec3 other = positions.at(name.substr(0, name.size() - 1) + "R");
            CHECK(glm::distance(position, other * Vec3(-1, 1, 1)) < 1e-6f);
            ++pairs;
        } else if (name.ends_with("_M")) {
            CHECK(std::abs(position.x) < 1e-6f);
        }
    }
    CHECK(pairs > 80);
}

TEST_CASE(
    "head markers: a recording of them moves the head through their surface, lips apart"
    * technique("face.mocap-drive")) {
    const std::vector<Vec3> truth = laugh(skin(), 1);
    const float motion = rms(truth, skin().positions);
    REQUIRE(motion > 1e-3f);
    REQUIRE(gap(skin().positions) < 1e-4f);
    REQUIRE(gap(truth) > 0.02f);
    const std::vector<Vec3> driven = perform(record_laugh(""));
    CHECK(rms(driven, truth) < 0.15f * motion);
    CHECK(std::abs(gap(driven) - gap(truth)) < 1e-4f);
    // Recordings have no markers inside lips and lids.
    const std::vector<Vec3> outside = perform(record_laugh("lid11"));
    CHECK(rms(outside, truth) < 0.25f * motion);
    CHECK(std::abs(gap(outside) - gap(truth)) < 1e-4f);
}

TEST_CASE("head markers: a bust follows them too; its shoulders stay, and its neck does not tear") {
    constexpr float kNeckEnd = -0.145f;  // [m]
    HeadShape shape;
    shape.shoulders = true;
    const MeshData bust = make_head(shape);
    const std::vector<Vec3> truth = laugh(bust, 1);
    const std::vector<Vec3> driven = perform(record_laugh(""), bust);
    CHECK(rms(driven, truth) < 0.15f * rms(truth, bust.positions));
    float moved = 0;
    float stretch = 0;
    for (std::size_t i = 0; i < bust.indices.size(); ++i) {
        const std::uint32_t a = bust.indices[i];
        const std::uint32_t b = bust.indices[i % 3 == 2 ? i - 2 : i + 1];
        if (bust.positions[a].y < -0.2f) {
            moved = std::max(moved, glm::distance(driven[a], bust.positions[a]));
        }
        if (std::abs(bust.positions[a].y - kNeckEnd) < 0.03f) {
            const Vec3 along = driven[b] - driven[a];
            stretch = std::max(stretch, glm::distance(along, truth[b] - truth[a]));
        }
    }
    CHECK(moved == 0);
    CHECK(stretch < 0.002f);  // half an edge of the skin there
}

TEST_CASE("head markers: a recording of other markers is rejected with the nearest name") {
    const MarkerSurface known = make_head_marker_surface();
    MarkerMotion motion;
    motion.names = {"mouth11_90_M", "mouth9_90_X"};
    motion.positions = {Vec3(0), Vec3(1)};
    const auto scene = make_marker_scene("take", motion, known);
    REQUIRE_FALSE(scene.ok());
    CHECK(
        scene.error().message
        == "take: the surface has no marker \"mouth9_90_X\" (did you mean mouth9_90_M?)");
}

}  // namespace limn::head_markers_test
