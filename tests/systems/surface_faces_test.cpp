#include "ecs/base/rng.h"
#include "ecs/components/animation.h"
#include "ecs/components/surface_binding.h"
#include "ecs/world.h"
#include "systems/animation/deform_mesh.h"
#include "systems/animation/skin_kernels.h"
#include "systems/animation/surface_binding_system.h"
#include "systems/animation/surface_faces.h"
#include "tests/near.h"
#include "tests/support.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace limn::surface_faces_test {
namespace {

using test::near;

/// A square of 2 x 2 m in y = 0 as a grid of `n` x `n` cells, its triangles facing +y.
MeshData make_sheet(int n) {
    MeshData mesh;
    mesh.name = "sheet";
    for (int z = 0; z <= n; ++z) {
        for (int x = 0; x <= n; ++x) {
            const Vec2 uv = Vec2(x, z) / static_cast<float>(n);
            mesh.positions.emplace_back(2 * uv.x - 1, 0, 2 * uv.y - 1);
            mesh.normals.emplace_back(0, 1, 0);
            mesh.tangents.emplace_back(1, 0, 0, 1);
            mesh.uvs.push_back(uv);
        }
    }
    const auto at = [n](int x, int z) { return static_cast<std::uint32_t>(z * (n + 1) + x); };
    for (int z = 0; z < n; ++z) {
        for (int x = 0; x < n; ++x) {
            for (const std::uint32_t v :
                 {at(x, z), at(x, z + 1), at(x + 1, z), at(x + 1, z), at(x, z + 1),
                  at(x + 1, z + 1)}) {
                mesh.indices.push_back(v);
            }
        }
    }
    return mesh;
}

std::vector<Vec3> points_around() {
    std::vector<Vec3> points;
    Random random(3, 1, 4, 1);
    for (int i = 0; i < 300; ++i) {
        points.push_back(1.5f * random.uniform() * random.direction());
    }
    return points;
}

/// Points bound to a sheet, and where they go with it.
struct Follower {
    MeshData sheet = make_sheet(4);
    std::vector<Vec3> points = points_around();
    SkinWeights weights;
    SkinData skin;

    explicit Follower(float locality = 4.0f, std::size_t count = 8) {
        sheet.positions[12].y = 0.3f;  // not flat
        sheet.positions[7].x += 0.1f;
        weights = bind_to_faces(points, {}, sheet.positions, sheet.indices, locality, count);
        skin = make_face_skin(sheet.positions, sheet.indices);
    }
    [[nodiscard]] std::vector<Vec3> follow(const std::vector<Vec3>& positions) const {
        std::vector<Affine> frames(sheet.indices.size() / 3);
        compute_face_frames(positions, sheet.indices, frames);
        std::vector<Affine> palette(frames.size());
        compute_skin_palette(skin, frames, palette);
        std::vector<Vec3> moved = points;
        std::vector<Vec3> normals(points.size(), Vec3(0, 1, 0));
        std::vector<Vec4> tangents(points.size(), Vec4(1, 0, 0, 1));
        const SkinnedVertices all = {moved, normals, tangents};
        skin_linear(weights, palette, {moved, normals, tangents}, all, 0, points.size());
        return moved;
    }
    template <typename Map>
    [[nodiscard]] std::vector<Vec3> follow_map(Map&& map) const {
        std::vector<Vec3> positions;
        for (const Vec3& p : sheet.positions) {
            positions.push_back(map(p));
        }
        return follow(positions);
    }
};

const Affine kTurn =
    affine_from({0.4f, -0.3f, 0.7f}, glm::normalize(Quat(0.6f, 0.3f, -0.5f, 0.4f)), Vec3(1));

}  // namespace

TEST_CASE(
    "surface faces: the weight of a face is 1 at it, a half at distance 1, and falls faster with "
    "locality"
    * technique("face.soffd")) {
    for (const float locality : {1.0f, 2.0f, 4.0f, 8.0f}) {
        CHECK(face_weight(0, locality) == 1.0f);
        CHECK(face_weight(1, locality) == 0.5f);
    }
    CHECK(face_weight(0.5f, 1) == near(0.666667));
    CHECK(face_weight(0.5f, 2) == near(0.8));
    CHECK(face_weight(0.5f, 4) == near(0.941176));
    CHECK(face_weight(0.5f, 8) == near(0.996109));
    CHECK(face_weight(2, 1) == near(0.333333));
    CHECK(face_weight(2, 2) == near(0.2));
    CHECK(face_weight(2, 4) == near(0.0588235));
    CHECK(face_weight(2, 8) == near(0.00389105));
    CHECK(face_weight(7, 0) == 0.5f);
}

TEST_CASE(
    "surface faces: weights of the requested number of nearest faces sum to 1"
    * technique("face.soffd")) {
    const Follower follower(4.0f, 5);
    const SkinWeights& weights = follower.weights;
    REQUIRE(weights.first.size() == follower.points.size() + 1);
    for (std::size_t p = 0; p < follower.points.size(); ++p) {
        float sum = 0.0f;
        CHECK(weights.first[p + 1] - weights.first[p] <= 5);
        CHECK(weights.first[p + 1] > weights.first[p]);
        for (std::uint32_t i = weights.first[p]; i < weights.first[p + 1]; ++i) {
            CHECK(weights.weights[i] > 0.0f);
            CHECK((i == weights.first[p] || weights.weights[i] <= weights.weights[i - 1]));
            sum += weights.weights[i];
        }
        CHECK(sum == near(1));
    }
    // A lone face, and faces that are all alike, still carry everything.
    const SkinWeights alike = bind_to_faces(
        follower.points, {}, follower.sheet.positions, follower.sheet.indices, 0.0f, 4);
    CHECK(alike.weights == std::vector<float>(4 * follower.points.size(), 0.25f));
}

TEST_CASE(
    "surface faces: a surface at rest moves nothing, and a rigid motion moves all rigidly"
    * technique("face.soffd")) {
    const Follower follower;
    const std::vector<Vec3> rest = follower.follow(follower.sheet.positions);
    const std::vector<Vec3> turned =
        follower.follow_map([](const Vec3& p) { return transform_point(kTurn, p); });
    for (std::size_t i = 0; i < rest.size(); ++i) {
        CHECK(glm::distance(rest[i], follower.points[i]) < 1e-5f);
        CHECK(glm::distance(turned[i], transform_point(kTurn, follower.points[i])) < 1e-5f);
    }
}

TEST_CASE(
    "surface faces: points scale by s with a surface that scales by s, also away from it"
    * technique("face.soffd")) {
    const Follower follower;
    for (const float s : {0.5f, 2.0f}) {
        const std::vector<Vec3> grown = follower.follow_map([s](const Vec3& p) { return s * p; });
        for (std::size_t i = 0; i < grown.size(); ++i) {
            CHECK(glm::distance(grown[i], s * follower.points[i]) < 2e-5f);
        }
    }
    // The plain cross product would take offsets by s^2.
    const Affine small = face_frame({0, 0, 0}, {0, 0, 1}, {1, 0, 0});
    const Affine large = face_frame({0, 0, 0}, {0, 0, 3}, {3, 0, 0});
    CHECK(transform_vector(small, {0, 0, 1}).y == near(1));
    CHECK(transform_vector(large, {0, 0, 1}).y == near(3));
}

TEST_CASE(
    "surface faces: the region moved by one vertex shrinks as influences get more local"
    * technique("face.soffd")) {
    float last = 10.0f;
    for (const float locality : {1.0f, 2.0f, 4.0f, 8.0f}) {
        const Follower follower(locality, 32);
        std::vector<Vec3> positions = follower.sheet.positions;
        positions[0].y += 1.0f;  // a corner of the sheet
        const std::vector<Vec3> moved = follower.follow(positions);
        float sum = 0.0f;
        float far = 0.0f;  // mean distance of what moves, weighted by how far it does
        for (std::size_t i = 0; i < moved.size(); ++i) {
            const float by = glm::distance(moved[i], follower.points[i]);
            sum += by;
            far += by * glm::distance(follower.points[i], follower.sheet.positions[0]);
        }
        CHECK(sum > 1.0f);
        CHECK(far / sum < 0.95f * last);
        last = far / sum;
    }
}

TEST_CASE(
    "surface faces: the deformed shape has no jump where other faces become the nearest"
    * technique("face.soffd")) {
    const MeshData sheet = make_sheet(4);
    std::vector<Vec3> line;
    for (int i = 0; i <= 4000; ++i) {
        line.emplace_back(-0.9f + 1.8f * static_cast<float>(i) / 4000.0f, 0.15f, 0.07f);
    }
    Follower follower;
    follower.sheet = sheet;
    follower.points = line;
    follower.weights = bind_to_faces(line, {}, sheet.positions, sheet.indices, 2.0f, 3);
    follower.skin = make_face_skin(sheet.positions, sheet.indices);
    const std::vector<Vec3> moved = follower.follow_map(
        [](const Vec3& p) { return p + Vec3(0, 0.3f * std::sin(3 * p.x) * std::cos(2 * p.z), 0); });
    float largest = 0.0f;
    for (std::size_t i = 1; i < moved.size(); ++i) {
        largest = std::max(largest, glm::distance(moved[i], moved[i - 1]));
    }
    CHECK(largest < 4 * 1.8f / 4000.0f);
}

TEST_CASE(
    "surface faces: of two touching surfaces, each moves the points that face the same direction"
    * technique("face.soffd")) {
    // Two lips: one that faces up, and one above it, almost in touch, that faces down.
    MeshData lips = make_sheet(4);
    const auto count = static_cast<std::uint32_t>(lips.positions.size());
    const std::size_t corners = lips.indices.size();
    for (std::uint32_t v = 0; v < count; ++v) {
        lips.positions.push_back(lips.positions[v] + Vec3(0, 0.01f, 0));
    }
    for (std::size_t i = 0; i < corners; i += 3) {
        for (const std::size_t k : {std::size_t{0}, std::size_t{2}, std::size_t{1}}) {
            lips.indices.push_back(lips.indices[i + k] + count);
        }
    }
    std::vector<Vec3> points;
    std::vector<Vec3> normals;
    for (float x = -0.8f; x < 0.8f; x += 0.1f) {
        points.insert(points.end(), {{x, 0.004f, 0.1f}, {x, 0.006f, 0.1f}});
        normals.insert(normals.end(), {{0, 1, 0}, {0, -1, 0}});
    }
    const SkinWeights weights =
        bind_to_faces(points, normals, lips.positions, lips.indices, 4.0f, 8);
    for (std::size_t p = 0; p < points.size(); ++p) {
        float other = 0.0f;
        for (std::uint32_t i = weights.first[p]; i < weights.first[p + 1]; ++i) {
            const bool is_upper = weights.joints[i] >= corners / 3;
            other += is_upper == (normals[p].y < 0) ? 0.0f : weights.weights[i];
        }
        CHECK(other < 0.01f);
    }
}

TEST_CASE(
    "surface faces: faces without area have no frame and are left out" * technique("face.soffd")) {
    MeshData sheet = make_sheet(2);
    const std::size_t all = sheet.indices.size();
    sheet.indices.insert(sheet.indices.end(), {0, 0, 1, 0, 1, 2});  // a point twice, a line
    const std::vector<std::uint32_t> faces = faces_with_area(sheet.positions, sheet.indices);
    CHECK(faces.size() == all);
    CHECK(faces_with_area(sheet.positions, std::vector<std::uint32_t>{3, 3, 3}).empty());
    const Affine flat = face_frame({1, 2, 3}, {1, 2, 3}, {1, 2, 3});
    CHECK(is_finite(transform_point(flat, {4, 5, 6})));
}

namespace {

/// A fine sheet bound to a coarse one.
struct BoundWorld {
    World world;
    Entity surface;
    Entity sheet;

    BoundWorld() {
        Assets assets;
        assets.meshes.push_back(make_sheet(12));
        assets.meshes.push_back(make_sheet(3));
        MeshData& coarse = assets.meshes[1];
        coarse.name = "coarse";
        coarse.morphs.push_back(
            {.name = "up",
             .action_unit = {},
             .vertices = {5, 6},
             .positions = {Vec3(0, 0.5f, 0), Vec3(0, 0.5f, 0)},
             .normals = {},
             .tangents = {}});
        world.insert_resource(std::move(assets));
        surface = world.create(ControlSurface{{1}}, MorphWeights{{0.0f}, {0.0f}}, Deformed{});
        world.get<Deformed>(surface).character = surface;
        SurfaceBinding binding;
        binding.surface = surface;
        sheet = world.create(MeshInstance{{0}, {}}, binding);
    }
    void step() {
        world.run(release_surface_bindings);
        world.run(add_surface_binding_states);
        world.run(bind_surfaces);
        world.run(update_surface_bindings);
    }
    std::vector<Vec3> shape() {
        const Assets& assets = world.resource<Assets>();
        const auto& state = world.get<SurfaceBindingState>(sheet);
        std::vector<Vec3> positions;
        CHECK(deform_positions(
            assets.meshes[world.get<MeshInstance>(sheet).mesh.index], world.get<Deformed>(sheet),
            &assets.skins[state.skin.index], &state.pose, nullptr, nullptr, positions));
        return positions;
    }
};

}  // namespace

TEST_CASE(
    "surface binding: a mesh follows its surface, and has velocities" * technique("face.soffd")) {
    BoundWorld bound;
    bound.step();
    const std::vector<Vec3> rest = bound.world.resource<Assets>().meshes[0].positions;
    const std::vector<Vec3> start = bound.shape();
    for (std::size_t i = 0; i < rest.size(); ++i) {
        CHECK(glm::distance(start[i], rest[i]) < 1e-5f);
    }
    CHECK(bound.world.get<Deformed>(bound.sheet).character == bound.sheet);
    const Pose first = bound.world.get<SurfaceBindingState>(bound.sheet).pose;
    CHECK(first.previous[4].row[1] == first.joints[4].row[1]);
    bound.world.get<MorphWeights>(bound.surface).weights[0] = 1.0f;
    bound.step();
    const std::vector<Vec3> moved = bound.shape();
    float highest = 0.0f;
    for (const Vec3& p : moved) {
        highest = std::max(highest, p.y);
    }
    CHECK(highest > 0.3f);
    CHECK(highest < 0.7f);
    const Pose& second = bound.world.get<SurfaceBindingState>(bound.sheet).pose;
    CHECK(second.previous[4].row[1] == first.joints[4].row[1]);
    CHECK(second.joints[4].row[1] != first.joints[4].row[1]);
}

TEST_CASE(
    "surface binding: a joint that moves no vertex of the surface moves none of the mesh"
    * technique("face.soffd-skin")) {
    BoundWorld bound;
    Assets& assets = bound.world.resource<Assets>();
    MeshData& coarse = assets.meshes[1];
    for (std::uint32_t v = 0; v <= coarse.positions.size(); ++v) {  // each by joint 0
        coarse.skin.first.push_back(v);
    }
    coarse.skin.joints.assign(coarse.positions.size(), 0);
    coarse.skin.weights.assign(coarse.positions.size(), 1.0f);
    const std::size_t painted = coarse.skin.weights.size();
    SkinData skin;
    skin.joints = {0, 1};
    skin.joint_from_mesh.assign(2, Affine{});
    assets.skins.push_back(skin);
    bound.world.get<Deformed>(bound.surface).skin = {0};
    Pose pose;
    pose.joints.assign(2, Affine{});
    bound.world.add(bound.surface, pose);
    bound.step();
    bound.world.get<Pose>(bound.surface).joints[1] = kTurn;
    bound.step();
    const std::vector<Vec3> rest = assets.meshes[0].positions;
    std::vector<Vec3> shape = bound.shape();
    for (std::size_t i = 0; i < rest.size(); ++i) {
        CHECK(glm::distance(shape[i], rest[i]) < 1e-5f);
    }
    // Weights are painted for the few vertices of the surface, and the other joint moves all.
    CHECK(painted * 8 < rest.size());
    bound.world.get<Pose>(bound.surface).joints[0] = kTurn;
    bound.step();
    shape = bound.shape();
    for (std::size_t i = 0; i < rest.size(); ++i) {
        CHECK(glm::distance(shape[i], transform_point(kTurn, rest[i])) < 1e-5f);
    }
}

TEST_CASE(
    "surface binding: equal bindings uv a mesh, and changed settings replace it"
    * technique("face.soffd-skin")) {
    BoundWorld bound;
    const Entity second = bound.world.create(
        MeshInstance{{0}, {}}, SurfaceBinding(bound.world.get<SurfaceBinding>(bound.sheet)));
    bound.step();
    const MeshId shared = bound.world.get<MeshInstance>(bound.sheet).mesh;
    CHECK(shared.index == 2);
    CHECK(bound.world.get<MeshInstance>(second).mesh == shared);
    CHECK(bound.world.resource<Assets>().meshes.size() == 3);
    bound.world.get<SurfaceBinding>(second).locality = 8.0f;
    bound.step();
    CHECK(bound.world.get<MeshInstance>(second).mesh.index == 3);
    CHECK(bound.world.get<MeshInstance>(bound.sheet).mesh == shared);
    for (int i = 0; i < 5; ++i) {
        bound.world.get<SurfaceBinding>(second).locality = 10.0f + static_cast<float>(i);
        bound.step();
    }
    CHECK(bound.world.get<MeshInstance>(second).mesh.index == 3);
    CHECK(bound.world.resource<Assets>().meshes.size() == 4);
    CHECK(bound.world.resource<Assets>().meshes[3].version == 6);
    // Another mesh to bind is bound as well.
    bound.world.get<MeshInstance>(second).mesh = {0};
    bound.step();
    CHECK(bound.world.get<MeshInstance>(second).mesh.index == 3);
    // The same settings as the other's: its mesh serves both, and the old one is freed.
    bound.world.get<SurfaceBinding>(second).locality = 4.0f;
    bound.step();
    CHECK(bound.world.get<MeshInstance>(second).mesh == shared);
    CHECK(bound.world.resource<Assets>().meshes[3].positions.empty());
}

TEST_CASE(
    "surface binding: a mesh that cannot be bound is logged once, and stays unchanged"
    * technique("face.soffd-skin")) {
    BoundWorld bound;
    const auto complaint = [&](Entity surface) {
        bound.world.get<SurfaceBinding>(bound.sheet).surface = surface;
        const std::vector<std::string> messages = test::messages_of([&] {
            bound.step();
            bound.step();
        });
        CHECK(bound.world.get<MeshInstance>(bound.sheet).mesh == MeshId{0});
        CHECK(bound.world.get<SurfaceBindingState>(bound.sheet).pose.joints.empty());
        REQUIRE(messages.size() == 1);
        CHECK(messages[0].find("surface_binding of mesh sheet: ") != std::string::npos);
        return messages[0];
    };
    const auto has = [](const std::string& text, const char* part) {
        return text.find(part) != std::string::npos;
    };
    CHECK(has(complaint({}), "no mesh"));
    CHECK(has(complaint(bound.world.create()), "no mesh"));
    CHECK(has(complaint(bound.sheet), "no mesh"));
    MeshData flat = make_sheet(2);
    flat.positions.assign(flat.positions.size(), Vec3(1));
    flat.name = "flat";
    bound.world.resource<Assets>().meshes.push_back(flat);
    CHECK(has(complaint(bound.world.create(ControlSurface{{2}})), "mesh flat has 0 faces"));
    // And is bound when it can be.
    bound.world.get<SurfaceBinding>(bound.sheet).surface = bound.surface;
    bound.step();
    CHECK(bound.world.get<MeshInstance>(bound.sheet).mesh != MeshId{0});
}

TEST_CASE("surface binding: without it, or without its surface, the original mesh is restored") {
    BoundWorld bound;
    bound.step();
    Assets& assets = bound.world.resource<Assets>();
    const MeshId copy = bound.world.get<MeshInstance>(bound.sheet).mesh;
    REQUIRE(copy != MeshId{0});
    const SurfaceBinding binding = bound.world.get<SurfaceBinding>(bound.sheet);
    const Entity other = bound.world.create(MeshInstance{{0}, {}}, SurfaceBinding(binding));
    bound.step();
    bound.world.remove<SurfaceBinding>(bound.sheet);
    bound.step();
    CHECK(bound.world.get<MeshInstance>(bound.sheet).mesh == MeshId{0});
    CHECK(bound.world.find<SurfaceBindingState>(bound.sheet) == nullptr);
    CHECK(bound.world.find<Deformed>(bound.sheet) == nullptr);
    // The copy serves the other one; then nothing.
    CHECK(bound.world.get<MeshInstance>(other).mesh == copy);
    CHECK_FALSE(assets.meshes[copy.index].positions.empty());
    bound.world.remove<SurfaceBinding>(other);
    bound.step();
    CHECK(assets.meshes[copy.index].positions.empty());
    // What deforms a mesh besides the binding goes on.
    bound.world.add(bound.sheet, SurfaceBinding(binding));
    Deformed by_morphs;
    by_morphs.character = bound.surface;
    bound.world.add(bound.sheet, by_morphs);
    bound.step();
    CHECK(bound.world.get<MeshInstance>(bound.sheet).mesh != MeshId{0});
    const std::vector<std::string> messages = test::messages_of([&] {
        bound.world.destroy(bound.surface);
        bound.step();
        bound.step();
    });
    CHECK(messages.size() == 1);
    CHECK(bound.world.get<MeshInstance>(bound.sheet).mesh == MeshId{0});
    CHECK(bound.world.find<Deformed>(bound.sheet) != nullptr);
}

}  // namespace limn::surface_faces_test
