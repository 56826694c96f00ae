#include "content/make/models/bar.h"
#include "content/make/models/creature.h"
#include "content/make/models/fur_coordinates.h"
#include "content/make/models/fur_strands.h"
#include "content/make/models/shapes.h"
#include "ecs/components/fur.h"
#include "ecs/world.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace limn::fur_meshes_test {

using namespace limn::test;

namespace {

double area_of(const MeshData& mesh) {
    double sum = 0;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const Vec3 a = mesh.positions[mesh.indices[i]];
        sum += static_cast<double>(glm::length(glm::cross(
            mesh.positions[mesh.indices[i + 1]] - a, mesh.positions[mesh.indices[i + 2]] - a)));
    }
    return 0.5 * sum;
}

MeshData mapped(MeshData mesh) {
    add_fur_coordinates(mesh);
    return mesh;
}

Assets assets_with(MeshData mesh) {
    Assets assets;
    assets.meshes.push_back(std::move(mesh));
    return assets;
}

}  // namespace

TEST_CASE(
    "fur coordinates: are in meters, and shrink lengths by at most sqrt(3)"
    * technique("shade.fur")) {
    const MeshData mesh = mapped(make_torus({.radius = 0.5f, .tube = 0.2f}));
    double longest = 0;
    double worst = 1e9;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const std::uint32_t a = mesh.indices[i];
        const std::uint32_t b = mesh.indices[i + 1];
        const std::uint32_t c = mesh.indices[i + 2];
        const Vec3 n = glm::cross(
            mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]);
        const Vec2 s = mesh.uvs1[b] - mesh.uvs1[a];
        const Vec2 t = mesh.uvs1[c] - mesh.uvs1[a];
        const double ratio = static_cast<double>(std::abs(s.x * t.y - s.y * t.x) / glm::length(n));
        longest = std::max(longest, ratio);
        worst = std::min(worst, ratio);
    }
    CHECK(longest <= 1.0001);
    CHECK(longest > 0.99);
    CHECK(worst >= 1 / std::sqrt(3.0) - 1e-3);  // of areas: one axis shrinks, the other not
}

TEST_CASE(
    "fur coordinates: vertices are split, and skins and morph targets with them"
    * technique("shade.fur")) {
    const MeshData fox = make_creature({.detail = 0.02f, .triangles = 1500});
    const MeshData mesh = mapped(fox);
    REQUIRE(mesh.uvs1.size() == mesh.positions.size());
    CHECK(mesh.positions.size() > fox.positions.size());
    CHECK(mesh.indices.size() == fox.indices.size());
    CHECK(area_of(mesh) == near(area_of(fox)).epsilon(1e-6));
    REQUIRE(mesh.skin.first.size() == mesh.positions.size() + 1);
    REQUIRE(mesh.morphs.size() == fox.morphs.size());
    CHECK(mesh.morphs[0].vertices.size() >= fox.morphs[0].vertices.size());
    CHECK(std::is_sorted(mesh.morphs[0].vertices.begin(), mesh.morphs[0].vertices.end()));
    bool same = true;
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        const std::uint32_t now = mesh.indices[i];
        const std::uint32_t old = fox.indices[i];
        same = same && mesh.positions[now] == fox.positions[old]
               && mesh.colors[now] == fox.colors[old]
               && mesh.skin.joints[mesh.skin.first[now]] == fox.skin.joints[fox.skin.first[old]];
    }
    CHECK(same);
}

TEST_CASE("fur coordinates: a second set is kept, and only meshes with fur get one") {
    MeshData ball = make_sphere({.radius = 1});
    ball.uvs1 = ball.uvs;
    const MeshData kept = mapped(ball);
    CHECK(kept.uvs1 == ball.uvs1);
    CHECK(kept.version == ball.version);
    CHECK(mapped({}).positions.empty());
    World world;
    world.insert_resource(assets_with(make_sphere({.radius = 1})));
    auto& assets = world.resource<Assets>();
    assets.meshes.push_back(make_sphere({.radius = 1}));
    world.create(MeshInstance{{0}, {}});
    world.create(MeshInstance{{1}, {}}, Fur{});
    world.create(MeshInstance{{7}, {}}, Fur{});  // no such mesh
    add_fur_coordinates(world);
    CHECK(assets.meshes[0].uvs1.empty());
    CHECK(assets.meshes[1].uvs1.size() == assets.meshes[1].positions.size());
    CHECK(assets.meshes[1].version == 1);
}

TEST_CASE("fur strands: roots are spread evenly over the area" * technique("shade.fur")) {
    // A flat sheet of two rectangles, one with many small triangles.
    MeshData sheet = make_plane({.size = {2, 1}});
    Assets assets = assets_with(sheet);
    const MeshData mesh = make_strands(
        {.mesh = {0},
         .count = 4000,
         .length = 0.1f,
         .width = 0.001f,
         .rows = 2,
         .droop = 0,
         .unruly = 0},
        assets);
    REQUIRE(mesh.positions.size() == 4000u * 4u);
    int quadrant[4] = {};
    for (std::size_t v = 0; v < mesh.positions.size(); v += 4) {
        const Vec3 root = 0.5f * (mesh.positions[v] + mesh.positions[v + 1]);
        CHECK_MESSAGE(std::abs(root.y) < 1e-5f, "roots lie on the surface");
        ++quadrant[(root.x > 0 ? 1 : 0) + (root.z > 0 ? 2 : 0)];
    }
    for (const int count : quadrant) {
        CHECK(count == near(1000).epsilon(0.1));
    }
}

TEST_CASE(
    "fur strands: stand on the surface, lean as they are combed, and have lengths in range"
    * technique("shade.fur")) {
    const Assets assets = assets_with(make_plane({.size = {1, 1}}));
    const MeshData mesh = make_strands(
        {.mesh = {0},
         .count = 500,
         .length = 0.2f,
         .width = 1e-4f,
         .rows = 3,
         .shortest = 0.5f,
         .comb = {0.75f, 0, 0},
         .droop = 1,
         .unruly = 0},
        assets);
    float shortest = 1e9f;
    float longest = 0;
    for (std::size_t v = 0; v + 5 < mesh.positions.size(); v += 6) {
        const Vec3 root = 0.5f * (mesh.positions[v] + mesh.positions[v + 1]);
        const Vec3 tip = 0.5f * (mesh.positions[v + 4] + mesh.positions[v + 5]);
        shortest = std::min(shortest, tip.y);
        longest = std::max(longest, tip.y);
        CHECK(tip.x - root.x == near(0.75f * tip.y).epsilon(1e-3));  // the ground adds nothing
        CHECK(tip.z == near(root.z).epsilon(1e-4));
        for (std::size_t k = v; k < v + 6; ++k) {
            // From root to tip: opposite to the bitangent.
            const Vec3 tangent(mesh.tangents[k]);
            const Vec3 along = -mesh.tangents[k].w * glm::cross(mesh.normals[k], tangent);
            CHECK(glm::dot(along, glm::normalize(tip - root)) > 0.6f);
            CHECK(std::abs(glm::dot(mesh.normals[k], along)) < 1e-5f);
        }
    }
    CHECK(shortest >= 0.1f);
    CHECK(longest <= 0.2f);
    CHECK(longest - shortest > 0.08f);
}

TEST_CASE("fur strands: have the weights of their roots, and none grow on bare skin") {
    const Assets assets = assets_with(make_creature({.detail = 0.02f, .triangles = 1500}));
    const MeshData& fox = assets.meshes[0];
    const MeshData mesh = make_strands({.mesh = {0}, .count = 2000, .rows = 3}, assets);
    REQUIRE(mesh.skin.first.size() == mesh.positions.size() + 1);
    CHECK(mesh.positions.size() < 2000u * 6u);  // the nose and the eyes are bare
    CHECK(mesh.positions.size() > 1500u * 6u);
    CHECK(mesh.morphs.size() == fox.morphs.size());
    float worst = 0;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        float sum = 0;
        for (std::uint32_t i = mesh.skin.first[v]; i < mesh.skin.first[v + 1]; ++i) {
            sum += mesh.skin.weights[i];
            worst = std::max(worst, mesh.skin.weights[i] > 0 ? 0.0f : 1.0f);
        }
        worst = std::max(worst, std::abs(sum - 1));
    }
    CHECK(worst < 1e-4f);
}

TEST_CASE("fur strands: the same seed gives the same strands; nothing grows on nothing") {
    const Assets assets = assets_with(make_torus({}));
    const StrandsShape shape = {.mesh = {0}, .count = 300};
    CHECK(make_strands(shape, assets).positions == make_strands(shape, assets).positions);
    StrandsShape other = shape;
    other.seed = 2;
    CHECK(make_strands(shape, assets).positions != make_strands(other, assets).positions);
    CHECK(make_strands({.mesh = {}, .count = 10}, assets).positions.empty());
    CHECK(make_strands({.mesh = {0}, .count = 0}, assets).positions.empty());
    Assets flat = assets_with({});
    flat.meshes[0].positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};  // without area
    flat.meshes[0].normals = std::vector<Vec3>(3, Vec3(0, 1, 0));
    flat.meshes[0].indices = {0, 1, 2};
    CHECK(make_strands({.mesh = {0}, .count = 10}, flat).positions.empty());
}

TEST_CASE("fur fins: stand on every edge once, across seams, too" * technique("shade.fur")) {
    // A tetrahedron whose faces share no vertex has 6 edges.
    const Vec3 p[] = {{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}};
    const int faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    MeshData tetrahedron;
    for (const auto& face : faces) {
        for (const int corner : face) {
            tetrahedron.indices.push_back(static_cast<std::uint32_t>(tetrahedron.positions.size()));
            tetrahedron.positions.push_back(p[corner]);
            tetrahedron.normals.push_back(glm::normalize(p[corner]));
        }
    }
    const MeshData mesh = make_fins({.mesh = {0}, .rows = 3}, assets_with(tetrahedron));
    REQUIRE(mesh.positions.size() == 6u * 6u);
    CHECK(mesh.indices.size() == 6u * 12u);
    for (std::size_t v = 0; v < mesh.positions.size(); v += 6) {
        CHECK(mesh.positions[v] == mesh.positions[v + 4]);
        CHECK(mesh.normals[v] == glm::normalize(mesh.positions[v]));
        CHECK(mesh.uvs1[v + 1].x - mesh.uvs1[v].x == near(std::sqrt(8.0)).epsilon(1e-4));
        CHECK(mesh.uvs1[v].y == 0);
        CHECK(mesh.uvs1[v + 3].y == 0.5f);
        CHECK(mesh.uvs1[v + 4].y == 1);
    }
}

}  // namespace limn::fur_meshes_test
