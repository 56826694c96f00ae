#include "content/bake/tangents.h"
#include "content/make/make_mesh.h"
#include "content/make/models/boulder.h"
#include "content/make/models/shapes.h"
#include "tests/content/mesh_laws.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <string>

namespace limn::shapes_test {

using namespace limn::test;

namespace {

constexpr double kPiD = 3.14159265358979323846;

/// The mesh that a level gets when it names a kind and nothing else.
MeshData make_default(const MeshKind& kind) {
    std::vector<std::byte> bytes(kind.parameters->size);
    kind.parameters->ops.construct_copy(bytes.data(), kind.parameters->defaults, 1);
    MeshData mesh = kind.make(bytes.data(), {});
    kind.parameters->ops.destroy(bytes.data(), 1);
    return mesh;
}

}  // namespace

TEST_CASE(
    "shapes: every kind makes unit frames, exact bounds and triangles that face their normals") {
    REQUIRE(mesh_kinds().size() == 36);
    for (const MeshKind& kind : mesh_kinds()) {
        const std::string name = kind.name;
        if (kind.make_rig != nullptr || name == "hovercraft" || name == "boat"
            || name == "fragments" || name == "head" || name == "simplified" || name == "retargeted"
            || name == "refined" || name == "joined" || name == "projected" || name == "strands"
            || name == "fins" || name == "body_part") {
            continue;  // bar_test.cpp, creature_test.cpp, person_test.cpp, hovercraft_test.cpp,
                       // boat_test.cpp, fragments_test.cpp, head_test.cpp; retargeted_test.cpp,
                       // refine_mesh_test.cpp, joined_test.cpp, projected_test.cpp and
                       // fur_meshes_test.cpp, of other meshes; body_part_test.cpp
        }
        INFO(name);
        const MeshData mesh = make_default(kind);
        check_arrays(mesh);
        // The lip of the teapot's spout, the rocks of the terrain and the edges of a boulder are
        // sharper than their quads.
        CHECK(
            worst_facing(mesh)
            > (name == "teapot"         ? 0.2f
               : name == "terrain"      ? 0.5f
               : name == "boulder"      ? 0.5f
               : name == "dodecahedron" ? 0.75f
                                        : 0.95f));
    }
}

TEST_CASE(
    "shapes: frames agree with differences of position and texture ever better with more quads") {
    CHECK(
        worst_tangent(make_sphere({.segments = 256, .rings = 128}))
        > 0.8f);  // poles: half a column off
    CHECK(worst_tangent(make_torus({.segments = 256, .sides = 128})) > 0.999f);
    CHECK(worst_tangent(make_cylinder({.segments = 256})) > 0.999f);
    CHECK(worst_tangent(make_plane({})) > 0.99999f);
    CHECK(worst_tangent(make_box({})) > 0.99999f);
    CHECK(worst_tangent(make_disc({.segments = 16, .divisions = 3})) > 0.9999f);
    CHECK(worst_facing(make_sphere({.segments = 256, .rings = 128})) > 0.999f);
    CHECK(worst_facing(make_torus({.segments = 256, .sides = 128})) > 0.999f);
}

TEST_CASE(
    "shapes: tangents from the formula are those that would be generated from the triangles") {
    for (const char* name : {"box", "cylinder", "disc", "plane", "sphere", "terrain", "torus"}) {
        INFO(std::string(name));
        const MeshData mesh = make_default(*find_kind(mesh_kinds(), name));
        MeshData generated = mesh;
        generate_tangents(generated);
        REQUIRE(generated.positions.size() == mesh.positions.size());  // nothing is mirrored
        float sum = 0;
        for (std::size_t i = 0; i < mesh.tangents.size(); ++i) {
            REQUIRE(generated.tangents[i].w == mesh.tangents[i].w);
            sum += glm::dot(Vec3(generated.tangents[i]), Vec3(mesh.tangents[i]));
        }
        CHECK(sum / static_cast<float>(mesh.tangents.size()) > 0.99f);
    }
}

TEST_CASE("shapes: closed shapes are watertight") {
    CHECK(open_edges(make_sphere({})) == 0);
    CHECK(open_edges(make_torus({})) == 0);
    CHECK(open_edges(make_box({})) == 0);
    CHECK(
        open_edges(
            make_box({.size = {1, 2, 3}, .bevel = 0.2f, .bevel_segments = 3, .divisions = 2}))
        == 0);
    CHECK(open_edges(make_box({.size = {1, 2, 1}, .bevel = 9.0f})) == 0);
    CHECK(open_edges(make_cylinder({.segments = 17, .divisions = 3})) == 0);
    CHECK(open_edges(make_cone({})) == 0);
    CHECK(open_edges(make_cone({.top_radius = 0.2f})) == 0);
    CHECK(open_edges(make_boulder({})) == 0);
    CHECK(open_edges(make_disc({.segments = 12})) == 12);
    CHECK(open_edges(make_plane({.divisions = 3})) == 12);
}

TEST_CASE("shapes: a boulder is as large as it says, another by seed, and flatter than a ball") {
    const BoulderShape shape = {.size = {2, 1, 1.5f}, .roughness = 0, .segments = 96, .rings = 48};
    const MeshData boulder = make_boulder(shape);
    const Vec3 extent = boulder.bounds.max - boulder.bounds.min;
    for (int axis = 0; axis < 3; ++axis) {
        CHECK(extent[axis] < 1.25f * shape.size[axis]);
        CHECK(extent[axis] > 0.75f * shape.size[axis]);
    }
    const double ellipsoid = kPiD / 6 * 2 * 1 * 1.5;
    CHECK(signed_volume(boulder) < 1.1 * ellipsoid);
    CHECK(signed_volume(boulder) > 0.5 * ellipsoid);
    for (int seed = 1; seed <= 40; ++seed) {  // few planes leave much between them
        const MeshData sharp = make_boulder(
            {.size = Vec3(1),
             .facets = 6,
             .wear = 0,
             .roughness = 0,
             .segments = 24,
             .rings = 12,
             .seed = seed});
        for (const Vec3& p : sharp.positions) {
            REQUIRE(glm::length(p) < 0.63f);
        }
    }
    BoulderShape other = shape;
    other.seed = 2;
    CHECK(make_boulder(other).positions != boulder.positions);
    // Of a fresh one, most of the surface faces one of a few directions.
    const auto largest_cluster = [](const MeshData& mesh) {
        std::size_t most = 0;
        for (std::size_t i = 0; i < mesh.normals.size(); i += 31) {
            std::size_t alike = 0;
            for (const Vec3& n : mesh.normals) {
                alike += glm::dot(n, mesh.normals[i]) > 0.995f ? 1 : 0;
            }
            most = std::max(most, alike);
        }
        return most;
    };
    BoulderShape fresh = shape;
    fresh.size = Vec3(1);
    fresh.wear = 0;
    CHECK(
        largest_cluster(make_boulder(fresh))
        > 3 * largest_cluster(make_sphere({.segments = 96, .rings = 48})));
}

TEST_CASE("shapes: a lathe turns its profile, closes its ends and has edges where it bends") {
    const MeshData tube = make_lathe({.profile = {{0.5f, 0}, {0.5f, 2}}, .segments = 256});
    CHECK(open_edges(tube) == 0);
    CHECK(signed_volume(tube) == test::near(kPiD * 0.5).epsilon(1e-3));
    // Half a circle as a profile is a ball: smooth, so that its normals are its radii.
    LatheShape half_circle{.segments = 96, .crease = 1.0f};
    half_circle.profile.clear();
    for (int i = 0; i <= 48; ++i) {
        const float angle = kPi * (static_cast<float>(i) / 48 - 0.5f);
        half_circle.profile.push_back({i % 48 == 0 ? 0.0f : std::cos(angle), std::sin(angle)});
    }
    const MeshData ball = make_lathe(half_circle);
    CHECK(open_edges(ball) == 0);
    CHECK(signed_volume(ball) == test::near(4.0 / 3.0 * kPiD).epsilon(3e-3));
    for (std::size_t i = 0; i < ball.positions.size(); ++i) {
        if (std::abs(ball.positions[i].y) < 0.99f) {  // at the ends there is one neighbor only
            REQUIRE(glm::dot(ball.positions[i], ball.normals[i]) > 0.9995f);
        }
    }
    // Every bend of a box's profile is more than a right angle's crease: flat parts stay flat.
    const MeshData drum =
        make_lathe({.profile = {{0.3f, 0}, {0.5f, 0}, {0.5f, 1}, {0.3f, 1}}, .segments = 12});
    CHECK(open_edges(drum) == 0);
    for (const Vec3& n : drum.normals) {
        CHECK((std::abs(n.y) < 1e-6f || std::abs(n.y) > 0.999999f));
    }
    CHECK(open_edges(make_lathe({.segments = 12, .caps = false})) == 24);
    check_arrays(make_lathe({.profile = {}}));
    check_arrays(make_lathe({.profile = {{1, 1}, {1, 1}}, .crease = 0}));
}

TEST_CASE("shapes: lobes keep a lathe closed, and its area is that of the curve") {
    const LatheShape pier{
        .profile = {{0.5f, 0}, {0.5f, 1}}, .segments = 240, .lobes = 4, .lobe_depth = 0.2f};
    const MeshData mesh = make_lathe(pier);
    check_arrays(mesh);
    CHECK(open_edges(mesh) == 0);
    CHECK(worst_facing(mesh) > 0.99f);
    CHECK(worst_tangent(mesh) > 0.95f);
    // The mean of (1 + d cos)^2 is 1 + d^2 / 2.
    CHECK(signed_volume(mesh) == test::near(kPiD * 0.25 * 1.02).epsilon(1e-3));
}

TEST_CASE(
    "shapes: a triangle in n divisions has n^2 facets of equal area that fill it"
    * technique("fakephong.scenes")) {
    for (const int n : {1, 2, 5}) {
        const MeshData mesh = make_triangle({.radius = 1, .divisions = n});
        CHECK(mesh.indices.size() == static_cast<std::size_t>(3 * n * n));
        const double whole = 0.75 * std::sqrt(3.0);
        for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
            const Vec3& a = mesh.positions[mesh.indices[i]];
            const Vec3 normal = 0.5f
                                * glm::cross(
                                    mesh.positions[mesh.indices[i + 1]] - a,
                                    mesh.positions[mesh.indices[i + 2]] - a);
            CHECK(static_cast<double>(normal.z) == near(whole / (n * n)));
        }
    }
}

TEST_CASE("shapes: metric texture coordinates are meters") {
    for (const MeshData& mesh :
         {make_box({.size = {3, 2, 5}, .metric = true}),
          make_plane({.size = {4, 7}, .divisions = 3, .metric = true})}) {
        for (std::size_t t = 0; t < mesh.indices.size(); ++t) {
            const std::uint32_t a = mesh.indices[t];
            const std::uint32_t b = mesh.indices[t % 3 == 2 ? t - 2 : t + 1];
            CHECK(
                glm::distance(mesh.uvs[a], mesh.uvs[b])
                == test::near(glm::distance(mesh.positions[a], mesh.positions[b])));
        }
        CHECK(worst_tangent(mesh) > 0.99999f);
    }
}

TEST_CASE("shapes: volume and area converge to the closed forms") {
    const MeshData ball = make_sphere({.radius = 0.5f, .segments = 256, .rings = 128});
    CHECK(signed_volume(ball) == test::near(kPiD / 6.0).epsilon(1e-3));
    CHECK(surface_area(ball) == test::near(kPiD).epsilon(1e-3));
    const MeshData ring =
        make_torus({.radius = 0.35f, .tube = 0.15f, .segments = 256, .sides = 128});
    CHECK(signed_volume(ring) == test::near(2 * kPiD * kPiD * 0.35 * 0.15 * 0.15).epsilon(1e-3));
    const MeshData tube = make_cylinder({.radius = 0.5f, .height = 2, .segments = 256});
    CHECK(signed_volume(tube) == test::near(kPiD * 0.5).epsilon(1e-3));
    const MeshData cone = make_cone({.radius = 0.5f, .height = 2, .segments = 256});
    CHECK(signed_volume(cone) == test::near(kPiD / 6.0).epsilon(1e-3));
    CHECK(signed_volume(make_box({.size = {1, 2, 3}})) == test::near(6.0));
    CHECK(surface_area(make_plane({.size = {2, 3}, .divisions = 4})) == test::near(6.0));
    CHECK(
        surface_area(make_disc({.radius = 1, .inner_radius = 0.5f, .segments = 256}))
        == test::near(0.75 * kPiD).epsilon(1e-3));

    // A box rounded by r: its core, six slabs, twelve quarter tubes and eight eighths of a ball.
    const double r = 0.25;
    const double core[3] = {0.5, 1.5, 2.5};
    const double rounded = core[0] * core[1] * core[2]
                           + 2 * r * (core[0] * core[1] + core[1] * core[2] + core[2] * core[0])
                           + kPiD * r * r * (core[0] + core[1] + core[2])
                           + 4.0 / 3.0 * kPiD * r * r * r;
    const MeshData soft = make_box({.size = {1, 2, 3}, .bevel = 0.25f, .bevel_segments = 24});
    CHECK(signed_volume(soft) == test::near(rounded).epsilon(1e-3));
}

TEST_CASE(
    "shapes: every vertex of a sphere is on the sphere, and moving it along its normal swells it") {
    const MeshData ball = make_sphere({.radius = 1.0f, .segments = 48, .rings = 24});
    for (std::size_t i = 0; i < ball.positions.size(); ++i) {
        REQUIRE(glm::length(ball.positions[i]) == test::near(1.0).epsilon(1e-6));
        REQUIRE(
            glm::length(ball.positions[i] + 0.2f * ball.normals[i])
            == test::near(1.2).epsilon(1e-6));
    }
}

TEST_CASE("shapes: a hard-edged box has 24 vertices and swelling it opens gaps of f sqrt(2)") {
    const MeshData box = make_box({});
    REQUIRE(box.positions.size() == 24);
    const float f = 0.1f;
    int pairs = 0;
    for (std::size_t a = 0; a < 24; ++a) {
        for (std::size_t b = a + 1; b < 24; ++b) {
            if (box.positions[a] == box.positions[b]) {
                ++pairs;
                const Vec3 gap = (box.positions[a] + f * box.normals[a])
                                 - (box.positions[b] + f * box.normals[b]);
                CHECK(glm::length(gap) == test::near(f * std::sqrt(2.0f)));
            }
        }
    }
    CHECK(pairs == 8 * 3);
}

TEST_CASE("shapes: a rounded box has one normal per point, so that swelling it opens no gap") {
    const MeshData box = make_box({.bevel = 0.1f, .bevel_segments = 2});
    std::map<std::array<float, 3>, Vec3> normals;
    for (std::size_t i = 0; i < box.positions.size(); ++i) {
        const Vec3 p = box.positions[i] + 0.0f;
        const auto [entry, fresh] = normals.try_emplace({p.x, p.y, p.z}, box.normals[i]);
        REQUIRE(glm::length(entry->second - box.normals[i]) < 1e-6f);
    }
    CHECK(normals.size() < box.positions.size());
}

TEST_CASE("shapes: the normals of a rounded edge turn by equal angles, and a bevel ends at half "
          "the size") {
    const MeshData box = make_box({.bevel = 0.2f, .bevel_segments = 2});
    int halfway = 0;
    for (const Vec3& n : box.normals) {
        if (std::abs(n.z) < 1e-6f && n.x > 1e-3f && n.y > 1e-3f) {
            const float angle = std::atan2(n.y, n.x) / radians(22.5f);
            CHECK(std::abs(angle - std::round(angle)) < 1e-4f);
            ++halfway;
        }
    }
    CHECK(halfway > 0);
    const MeshData ball = make_box({.size = {2, 2, 2}, .bevel = 9, .bevel_segments = 16});
    CHECK(ball.bounds.max == Vec3(1));
    CHECK(signed_volume(ball) == test::near(kPiD * 4 / 3).epsilon(0.01));
}

TEST_CASE("shapes: at a pole each triangle has its own vertex, half way between its columns") {
    const MeshData ball = make_sphere({.segments = 8, .rings = 4});
    const MeshData cone = make_cone({.segments = 8, .caps = false});
    for (const MeshData* mesh : {&ball, &cone}) {
        for (std::size_t t = 0; t < mesh->indices.size(); t += 3) {
            float u[3];
            float apex = -1;
            for (std::size_t k = 0; k < 3; ++k) {
                const Vec3 p = corner(*mesh, t + k);
                u[k] = mesh->uvs[mesh->indices[t + k]].x;
                apex = p.x == 0 && p.z == 0 ? u[k] : apex;
            }
            if (apex >= 0) {
                const float low = std::min({u[0], u[1], u[2]});
                const float high = std::max({u[0], u[1], u[2]});
                CHECK(apex == test::near(0.5f * (low + high)));
                CHECK(high - low == test::near(1.0f / 8));
            }
        }
    }
}

TEST_CASE("shapes: an image stands upright and unmirrored on the front of a sphere") {
    // Seen from +z with +y up: u grows toward +x, v toward -y.
    const MeshData ball = make_sphere({.radius = 1.0f});
    for (std::size_t i = 0; i < ball.positions.size(); ++i) {
        const Vec2 from_middle = ball.uvs[i] - 0.5f;
        if (std::abs(from_middle.x) < 0.2f && std::abs(from_middle.y) < 0.4f) {
            REQUIRE(ball.positions[i].z > 0);
            REQUIRE(ball.positions[i].x * from_middle.x >= 0);
            REQUIRE(ball.positions[i].y * from_middle.y <= 1e-6f);
        }
    }
}

TEST_CASE("shapes: kinds are found by name, and the error for a typo suggests the nearest") {
    REQUIRE(find_kind(mesh_kinds(), "teapot") != nullptr);
    CHECK(find_kind(mesh_kinds(), "tea pot") == nullptr);
    CHECK(kind_suggestion(mesh_kinds(), "teapod") == " (did you mean teapot?)");
    CHECK(kind_suggestion(mesh_kinds(), "quarterdeck") == "");
    for (const MeshKind& kind : mesh_kinds()) {
        INFO(std::string(kind.name));
        CHECK(!kind.parameters->fields.empty());
        for (const FieldInfo& field : kind.parameters->fields) {
            INFO(std::string(field.name));
            CHECK(std::string(field.meta.doc) != "");
        }
    }
}

}  // namespace limn::shapes_test
