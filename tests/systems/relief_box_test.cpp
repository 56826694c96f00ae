#include "ecs/world.h"
#include "systems/relief_box_system.h"
#include "systems/update_world.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <random>
#include <set>
#include <utility>

namespace limn::test::relief_box_test {
namespace {

constexpr Vec3 kHalf = {1, 0.5f, 2};

/// A vertex of the mesh at `p`.
struct Corner {
    Vec2 uv;
    float depth;
};
Corner corner_at(const MeshData& mesh, const Vec3& p) {
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        if (glm::length(mesh.positions[i] - p) < 1e-6f) {
            return {mesh.uvs[i], mesh.uvs1[i].x};
        }
    }
    FAIL("no vertex there");
    return {};
}

/// The corners of each polygon, whose triangles are fans.
std::vector<std::vector<Vec3>> polygons_of(const MeshData& mesh) {
    std::vector<std::vector<Vec3>> polygons;
    std::uint32_t first = ~0u;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        if (mesh.indices[i] != first) {
            first = mesh.indices[i];
            polygons.push_back({mesh.positions[first], mesh.positions[first + 1]});
        }
        polygons.back().push_back(mesh.positions[mesh.indices[i + 2]]);
    }
    return polygons;
}

/// A box with six maps before a camera on its diagonal, `distance` away.
struct BoxWorld {
    World world;
    Schedule schedule = make_world_schedule();
    Entity camera;
    Entity box;

    explicit BoxWorld(ReliefBox made, float distance = 5) {
        Assets assets;
        for (int i = 0; i < kReliefFaces; ++i) {
            assets.materials.push_back(Material{.detail = SurfaceDetail::DoubleDepth});
        }
        world.insert_resource(std::move(assets));
        for (const auto& [side, index] :
             {std::pair(&made.front, 0u), std::pair(&made.back, 1u), std::pair(&made.left, 2u),
              std::pair(&made.right, 3u), std::pair(&made.top, 4u), std::pair(&made.bottom, 5u)}) {
            side->index = index;
        }
        const Vec3 eye = Vec3(distance / std::sqrt(3.0f));
        const Quat rotation = glm::quatLookAt(glm::normalize(-eye), Vec3(0, 1, 0));
        camera = world.create(Transform{.position = eye, .rotation = rotation}, Camera{});
        box = world.create(Transform{}, made);
        start_world(world);
    }
    const ReliefBoxState& state() { return std::as_const(world).get<ReliefBoxState>(box); }
    const Assets& assets() { return world.resource<Assets>(); }
    /// Planes that are drawn of all maps.
    std::size_t planes() {
        std::size_t count = 0;
        for (const ReliefBoxPart& part : state().sliced) {
            count += part.mesh.index < assets().meshes.size()
                         ? polygons_of(assets().meshes[part.mesh.index]).size()
                         : 0;
        }
        return count;
    }
};

}  // namespace

TEST_CASE(
    "relief box: one, two or three sides face a viewer outside, none one inside"
    * technique("relief.multi-face")) {
    const auto count = [](const Vec3& eye) { return std::popcount(facing_sides(eye, kHalf)); };
    CHECK(count({3, 3, 3}) == 3);
    CHECK(count({-3, 3, 0}) == 2);
    CHECK(count({0, 0, -3}) == 1);
    CHECK(facing_sides({0, 0, 3}, kHalf) == 1u << static_cast<int>(ReliefFace::Front));
    CHECK(facing_sides({0, -3, 0}, kHalf) == 1u << static_cast<int>(ReliefFace::Bottom));
    std::mt19937 random(2);
    std::uniform_real_distribution<float> any(-4, 4);
    for (int i = 0; i < 1000; ++i) {
        const Vec3 eye = {any(random), any(random), any(random)};
        const bool inside =
            std::abs(eye.x) <= kHalf.x && std::abs(eye.y) <= kHalf.y && std::abs(eye.z) <= kHalf.z;
        CHECK(count(eye) <= 3);
        CHECK((count(eye) == 0) == inside);
    }
}

TEST_CASE(
    "relief box: texture coordinates run over each side as baked, the third into the box"
    * technique("relief.box")) {
    const MeshData front = make_box_sides(ReliefFace::Front, 0x3f);
    CHECK(front.positions.size() == 24);
    const auto check = [&](const MeshData& mesh, const Vec3& p, const Vec2& uv, float depth) {
        const Corner corner = corner_at(mesh, p);
        CHECK(corner.uv == uv);
        CHECK(corner.depth == depth);
    };
    check(front, {-0.5f, 0.5f, 0.5f}, {0, 0}, 0);
    check(front, {0.5f, 0.5f, 0.5f}, {1, 0}, 0);
    check(front, {0.5f, -0.5f, 0.5f}, {1, 1}, 0);
    check(front, {-0.5f, -0.5f, -0.5f}, {0, 1}, 1);
    check(make_box_sides(ReliefFace::Right, 0x3f), {0.5f, 0.5f, 0.5f}, {0, 0}, 0);
    check(make_box_sides(ReliefFace::Top, 0x3f), {-0.5f, 0.5f, -0.5f}, {0, 0}, 0);
    check(make_box_sides(ReliefFace::Back, 0x3f), {0.5f, 0.5f, 0.5f}, {0, 0}, 1);
    // Each side faces outwards.
    for (std::size_t i = 0; i < front.indices.size(); i += 3) {
        const Vec3 a = front.positions[front.indices[i]];
        const Vec3 b = front.positions[front.indices[i + 1]];
        const Vec3 c = front.positions[front.indices[i + 2]];
        CHECK(glm::dot(glm::cross(b - a, c - a), a + b + c) > 0);
    }
}

TEST_CASE(
    "relief slices: their number falls with the distance in four levels, without flicker"
    * technique("relief.slices-lod")) {
    std::set<int> counts;
    int last = 1 << 20;
    for (float distance = 1; distance < 200; distance *= 1.02f) {
        const int count = choose_slice_count(100 / distance, 0, 8, 64);
        CHECK(count <= last);
        CHECK(static_cast<float>(count) >= std::min(100 / distance, 64.0f));
        last = count;
        counts.insert(count);
    }
    CHECK(counts == std::set{8, 16, 32, 64});
    // A distance that jitters by 20 % about a threshold changes nothing.
    CHECK(choose_slice_count(33, 0, 8, 256) == 64);
    CHECK(choose_slice_count(33, 32, 8, 256) == 32);
    CHECK(choose_slice_count(38, 32, 8, 256) == 32);
    CHECK(choose_slice_count(39, 32, 8, 256) == 64);
    CHECK(choose_slice_count(28, 64, 8, 256) == 64);
    CHECK(choose_slice_count(26, 64, 8, 256) == 32);
    // Limits hold at once.
    CHECK(choose_slice_count(1e30f, 0, 8, 100) == 100);
    CHECK(choose_slice_count(0, 0, 3, 100) == 3);
    CHECK(choose_slice_count(50, 256, 8, 16) == 16);
}

TEST_CASE(
    "relief slices: planes parallel to the map are at depths of k / n, the deepest first"
    * technique("relief.slices")) {
    const MeshData mesh = make_face_slices(ReliefFace::Left, 5);
    REQUIRE(mesh.positions.size() == 20);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const float depth = 1 - static_cast<float>(i / 4) / 5;
        CHECK(mesh.uvs1[i].x == near(depth));
        CHECK(mesh.positions[i].x == near(depth - 0.5f).scale(1));
    }
}

TEST_CASE(
    "relief slices: planes that face the viewer are polygons of three to six corners in the box"
    * technique("relief.slices-view")) {
    std::mt19937 random(7);
    std::normal_distribution<float> any(0, 1);
    std::set<std::size_t> sizes;
    for (int i = 0; i < 50; ++i) {
        const Vec3 normal = {any(random), any(random), any(random)};
        const float reach = 0.5f * (std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z));
        float last = -reach - 1e-4f;
        const MeshData mesh = make_view_slices(ReliefFace::Front, normal, 32);
        const auto polygons = polygons_of(mesh);
        CHECK(polygons.size() >= 31);  // the last one touches a corner
        for (const std::vector<Vec3>& polygon : polygons) {
            sizes.insert(polygon.size());
            const float distance = glm::dot(polygon[0], normal);
            CHECK(distance > last);  // nearer than the plane before
            last = distance;
            for (const Vec3& p : polygon) {
                CHECK(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) <= 0.5f + 1e-6f);
                CHECK(glm::dot(p, normal) == near(distance).scale(1).epsilon(1e-5));
            }
            // Its front faces the viewer.
            CHECK(
                glm::dot(glm::cross(polygon[1] - polygon[0], polygon[2] - polygon[0]), normal)
                >= 0);
        }
        for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
            CHECK(mesh.uvs1[v].x == near(0.5f - mesh.positions[v].z).scale(1).epsilon(1e-6));
        }
    }
    CHECK(*sizes.begin() == 3);
    CHECK(*sizes.rbegin() == 6);
}

TEST_CASE(
    "relief slices: for a viewer in front both alignments are the same planes"
    * technique("relief.slices-view")) {
    const MeshData face = make_face_slices(ReliefFace::Top, 16);
    const MeshData view = make_view_slices(ReliefFace::Top, {0, 3, 0}, 16);
    REQUIRE(view.positions.size() == face.positions.size());
    for (std::size_t i = 0; i < 4; ++i) {
        CHECK(face.positions[4 * 7 + i].y == near(view.positions[4 * 7 + i].y).scale(1));
    }
    for (const Vec3& p : view.positions) {
        CHECK(std::abs(p.x) == near(0.5));
        CHECK(std::abs(p.z) == near(0.5));
    }
}

TEST_CASE(
    "relief box: each map that faces the camera has a stack of slices, the others none"
    * technique("relief.multi-face, relief.slices, relief.slices-lod")) {
    BoxWorld near_box({.slices = ReliefSlices::Face, .min_slices = 64, .max_slices = 64});
    CHECK(std::popcount(near_box.state().faces) == 3);
    CHECK(near_box.state().slice_count == 64);
    CHECK(near_box.planes() == 192);

    // Moved to an axis, it is one stack.
    near_box.world.get<Transform>(near_box.camera).position = {0, 0, 5};
    step_world(near_box.world, near_box.schedule);
    CHECK(std::popcount(near_box.state().faces) == 1);
    CHECK(near_box.planes() == 64);

    // A depth of 1 m at 5 m is 232 px of 1080 rows at 50 degrees.
    BoxWorld far_box({.slices = ReliefSlices::Face, .slice_pixels = 1});
    CHECK(far_box.state().slice_count == 256);
    far_box.world.get<Transform>(far_box.camera).position *= 10.0f;
    step_world(far_box.world, far_box.schedule);
    CHECK(far_box.state().slice_count == 32);
    // As far, but ten times as large.
    far_box.world.get<Transform>(far_box.box).scale = Vec3(10);
    step_world(far_box.world, far_box.schedule);
    CHECK(far_box.state().slice_count == 256);
}

TEST_CASE(
    "relief box: its parts show the maps of their sides and follow their materials"
    * technique("relief.box, relief.multi-face")) {
    BoxWorld six({});
    CHECK(six.state().slice_count == 0);
    CHECK(six.planes() == 0);
    for (const ReliefBoxPart& part : six.state().searched) {
        CHECK(polygons_of(six.assets().meshes[part.mesh.index]).size() == 1);
        CHECK(six.assets().materials[part.material.index].detail == kClosedReliefBoxDetail);
    }
    const std::size_t materials = six.assets().materials.size();
    auto& assets = six.world.resource<Assets>();
    assets.materials[0].roughness = 0.123f;
    ++assets.material_version;
    for (int i = 0; i < 3; ++i) {
        step_world(six.world, six.schedule);
    }
    const auto front = static_cast<std::size_t>(ReliefFace::Front);
    const MaterialId copy = six.state().searched[front].material;
    CHECK(six.assets().materials[copy.index].roughness == 0.123f);
    CHECK(six.assets().materials.size() == materials);
    const std::uint64_t version = six.assets().material_version;
    step_world(six.world, six.schedule);
    CHECK(six.assets().material_version == version);

    // With one map it is visible from all sides, or all but below.
    auto& box = six.world.get<ReliefBox>(six.box);
    box = {.front = box.front};
    step_world(six.world, six.schedule);
    const auto sides = [&] {
        return polygons_of(six.assets().meshes[six.state().searched[front].mesh.index]).size();
    };
    CHECK(sides() == 6);
    six.world.get<ReliefBox>(six.box).hide_bottom = true;
    step_world(six.world, six.schedule);
    CHECK(sides() == 5);
}

TEST_CASE("relief box: without a material, or in a place that is not finite, nothing is drawn") {
    BoxWorld scene({.slices = ReliefSlices::View});
    scene.world.get<Transform>(scene.box).position = Vec3(NAN);
    step_world(scene.world, scene.schedule);
    CHECK(scene.state().slice_count == 0);
    scene.world.get<Transform>(scene.box).position = Vec3(0);
    scene.world.get<ReliefBox>(scene.box) = {.front = {77}, .slices = ReliefSlices::Face};
    step_world(scene.world, scene.schedule);
    CHECK(scene.planes() == 0);
    for (const ReliefBoxPart& part : scene.state().searched) {
        CHECK(scene.assets().meshes[part.mesh.index].indices.empty());
    }
}

}  // namespace limn::test::relief_box_test
