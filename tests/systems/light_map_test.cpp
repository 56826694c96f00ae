#include "ecs/components/all.h"
#include "ecs/world.h"
#include "systems/light/light_map_charts.h"
#include "systems/light/light_map_system.h"
#include "tests/near.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <set>
#include <vector>

namespace limn::light_map_test {

using test::near;

namespace {

/// The faces of a box about the origin, each with its own vertices.
MeshData box_mesh(const Vec3& size) {
    MeshData mesh;
    mesh.name = "box";
    for (int face = 0; face < 6; ++face) {
        const int axis = face / 2;
        const float side = face % 2 == 0 ? 1.0f : -1.0f;
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (int corner = 0; corner < 4; ++corner) {
            Vec3 p(0);
            p[axis] = side;
            p[(axis + 1) % 3] = corner == 1 || corner == 2 ? 1.0f : -1.0f;
            p[(axis + 2) % 3] = corner >= 2 ? 1.0f : -1.0f;
            mesh.positions.push_back(0.5f * p * size);
            mesh.normals.push_back(Vec3(0));
            mesh.normals.back()[axis] = side;
            mesh.tangents.emplace_back(1, 0, 0, 1);
            mesh.uvs.emplace_back(0);
            grow(mesh.bounds, mesh.positions.back());
        }
        for (const std::uint32_t k : {0u, 1u, 2u, 0u, 2u, 3u}) {
            mesh.indices.push_back(first + (side > 0 ? k : (k == 0 ? 0 : 4 - k)));
        }
    }
    return mesh;
}

/// A square of side 2 in y = 0 that faces up, `cells` along a side.
MeshData floor_mesh(int cells) {
    MeshData mesh;
    mesh.name = "floor";
    for (int z = 0; z <= cells; ++z) {
        for (int x = 0; x <= cells; ++x) {
            const Vec2 at = Vec2(x, z) * (2.0f / static_cast<float>(cells)) - 1.0f;
            mesh.positions.emplace_back(at.x, 0, at.y);
            mesh.normals.emplace_back(0, 1, 0);
            mesh.tangents.emplace_back(1, 0, 0, 1);
            mesh.uvs.emplace_back(0);
            grow(mesh.bounds, mesh.positions.back());
        }
    }
    for (int z = 0; z < cells; ++z) {
        for (int x = 0; x < cells; ++x) {
            const auto a = static_cast<std::uint32_t>(z * (cells + 1) + x);
            const auto below = a + static_cast<std::uint32_t>(cells) + 1;
            mesh.indices.insert(mesh.indices.end(), {a, below, below + 1, a, below + 1, a + 1});
        }
    }
    return mesh;
}

Affine placed(const Vec3& position) {
    return affine_from(position, {1, 0, 0, 0}, Vec3(1));
}

/// A floor with its light map.
struct MappedFloor {
    LightMapState state;
    ImageData image;
    LightMapFormat format;

    explicit MappedFloor(LightMapFormat with = LightMapFormat::Floats) : format(with) {
        const auto charted = cut_into_charts(floor_mesh(3), 16);
        REQUIRE(charted.has_value());
        image = make_light_map_image(format, charted->width, charted->height);
        state.texels = light_map_texels(charted->mesh, charted->width, charted->height);
        state.patches = make_light_map_patches(state.texels, charted->width);
    }
    std::uint64_t light(std::vector<PlacedSource> sources, const MeshBvh* occluders = nullptr) {
        return update_light_map(state, format, std::move(sources), occluders, image);
    }
    /// Red of a texel, in 0 .. 255 or as it is.
    [[nodiscard]] float red(std::size_t texel) const {
        const std::size_t pixel = state.texels[texel].pixel;
        if (format == LightMapFormat::Bytes) {
            return image.pixels[4 * pixel];
        }
        float value = 0;
        std::memcpy(&value, &image.pixels[sizeof(Vec4) * pixel], sizeof value);
        return value;
    }
};

PlacedSource lamp(std::uint32_t number, const Vec3& position, float radius, float intensity = 1) {
    return {
        {number, 1},
        light_map_source(PointLight{.intensity = intensity, .radius = radius}, placed(position))};
}

/// Irradiance / pi of `value` on all of a floor.
PlacedSource uniform(std::uint32_t number, float value) {
    return {{number, 1}, {.color = Vec3(kPi * value), .axis = {0, -1, 0}, .directional = true}};
}

/// The texel at barycentric weights of a triangle.
Vec2 chart_point(const MeshData& mesh, std::size_t triangle, const Vec3& weights) {
    Vec2 uv(0);
    for (std::size_t k = 0; k < 3; ++k) {
        uv += weights[static_cast<int>(k)] * mesh.uvs1[mesh.indices[3 * triangle + k]];
    }
    return uv;
}

Vec3 mesh_point(const MeshData& mesh, std::size_t triangle, const Vec3& weights) {
    Vec3 p(0);
    for (std::size_t k = 0; k < 3; ++k) {
        p += weights[static_cast<int>(k)] * mesh.positions[mesh.indices[3 * triangle + k]];
    }
    return p;
}

}  // namespace

TEST_CASE(
    "light map: charts of a box keep its shape, and every filtered lookup is on the right face"
    * technique("light.lightmap")) {
    const MeshData box = box_mesh({2, 1, 3});
    const auto charted = cut_into_charts(box, 10);
    REQUIRE(charted.has_value());
    const MeshData& mesh = charted->mesh;
    REQUIRE(mesh.indices.size() == box.indices.size());
    const std::vector<LightMapTexel> texels =
        light_map_texels(mesh, charted->width, charted->height);
    std::vector<const LightMapTexel*> at(
        static_cast<std::size_t>(charted->width * charted->height), nullptr);
    for (const LightMapTexel& texel : texels) {
        CHECK(at[texel.pixel] == nullptr);
        at[texel.pixel] = &texel;
    }
    // 22 m^2 of 100 texels each, and borders.
    CHECK(texels.size() > 2200);
    CHECK(texels.size() < 2900);
    for (std::size_t t = 0; t < mesh.indices.size() / 3; ++t) {
        for (const Vec3 weights :
             {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(0.5f, 0.5f, 0),
              Vec3(0.2f, 0.3f, 0.5f)}) {
            const Vec3 p = mesh_point(mesh, t, weights);
            CHECK(p == mesh_point(box, t, weights));
            const Vec2 uv = chart_point(mesh, t, weights) * Vec2(charted->width, charted->height);
            for (int corner = 0; corner < 4; ++corner) {  // of the linear filter
                const int x = static_cast<int>(std::floor(uv.x - 0.5f)) + corner % 2;
                const int y = static_cast<int>(std::floor(uv.y - 0.5f)) + corner / 2;
                REQUIRE(x >= 0);
                REQUIRE(y >= 0);
                const LightMapTexel* const texel =
                    at[static_cast<std::size_t>(y * charted->width + x)];
                REQUIRE(texel != nullptr);
                CHECK(glm::distance(texel->normal, mesh.normals[mesh.indices[3 * t]]) < 1e-5f);
                CHECK(glm::length(texel->position - p) < 0.15f);  // a diagonal of a texel
            }
        }
    }
}

TEST_CASE(
    "light map: of a ball, too, no texel belongs to two charts" * technique("light.lightmap")) {
    MeshData ball = floor_mesh(24);  // wrapped around
    for (std::size_t i = 0; i < ball.positions.size(); ++i) {
        const Vec3 p = ball.positions[i];
        const float polar = 0.5f * kPi * (p.x + 1);
        const float around = kPi * p.z;
        ball.normals[i] = {
            std::sin(polar) * std::cos(around), std::cos(polar),
            std::sin(polar) * std::sin(around)};
        ball.positions[i] = ball.normals[i];
    }
    const auto charted = cut_into_charts(ball, 16);
    REQUIRE(charted.has_value());
    const auto texels = light_map_texels(charted->mesh, charted->width, charted->height);
    // Where charts overlapped, texels would be missing: the surface seen along six axes has at
    // least 4 pi / sqrt(3) m^2.
    CHECK(texels.size() > static_cast<std::size_t>(256 * 4 * kPi / std::sqrt(3.0f)));
    for (const LightMapTexel& texel : texels) {
        CHECK(glm::length(texel.position) == near(1).epsilon(0.02));
    }
}

TEST_CASE("light map: meshes that cannot be cut have no charts, large ones fewer texels") {
    CHECK(!cut_into_charts(MeshData{}, 16).has_value());
    MeshData flat = floor_mesh(1);
    for (Vec3& p : flat.positions) {
        p = Vec3(1);
    }
    CHECK(!cut_into_charts(flat, 16).has_value());
    flat.positions[0].x = std::nanf("");
    CHECK(!cut_into_charts(flat, 16).has_value());
    const auto large = cut_into_charts(floor_mesh(1), 1e6f);
    REQUIRE(large.has_value());
    CHECK(std::max(large->width, large->height) <= kMaxLightMapSize);
    CHECK(large->width > kMaxLightMapSize / 4);
}

TEST_CASE(
    "light map: bytes lose what saturates, floats do not: 0.7 and 0.6 without 0.6 are 0.7"
    * technique("light.lightmap")) {
    constexpr float kFirst = 179 / 255.0f;
    constexpr float kSecond = 153 / 255.0f;
    MappedFloor bytes(LightMapFormat::Bytes);
    bytes.light({uniform(1, kFirst)});
    CHECK(bytes.red(5) == 179);
    bytes.light({uniform(1, kFirst), uniform(2, kSecond)});
    CHECK(bytes.red(5) == 255);
    bytes.light({uniform(1, kFirst)});
    CHECK(bytes.red(5) == 102);

    MappedFloor floats;
    floats.light({uniform(1, kFirst)});
    const std::vector<std::uint8_t> one = floats.image.pixels;
    CHECK(floats.red(5) == near(double(kFirst)));
    floats.light({uniform(1, kFirst), uniform(2, kSecond)});
    CHECK(floats.red(5) == near(double(kFirst + kSecond)));
    floats.light({uniform(1, kFirst)});
    CHECK(floats.image.pixels == one);
}

TEST_CASE(
    "light map: a texel outside all spheres of influence keeps its bits, one inside changes"
    * technique("light.lightmap")) {
    MappedFloor floor;
    floor.light({lamp(1, {0, 3, 0}, 0), lamp(2, {-0.6f, 0.3f, -0.6f}, 0.5f)});
    const std::vector<std::uint8_t> before = floor.image.pixels;
    const std::uint32_t version = floor.image.version;
    const Vec3 from = {-0.6f, 0.3f, -0.6f};
    const Vec3 to = {-0.4f, 0.3f, -0.5f};
    const std::uint64_t touched = floor.light({lamp(1, {0, 3, 0}, 0), lamp(2, to, 0.5f)});
    CHECK(floor.image.version == version + 1);
    std::size_t outside = 0;
    std::size_t changed = 0;
    for (const LightMapTexel& texel : floor.state.texels) {
        const bool same = std::memcmp(
                              &before[sizeof(Vec4) * texel.pixel],
                              &floor.image.pixels[sizeof(Vec4) * texel.pixel], sizeof(Vec4))
                          == 0;
        if (glm::distance(texel.position, from) > 0.5f
            && glm::distance(texel.position, to) > 0.5f) {
            ++outside;
            CHECK(same);
        } else {
            changed += same ? 0 : 1;
        }
    }
    CHECK(changed > 100);
    CHECK(outside > 500);
    CHECK(touched < floor.state.texels.size() / 2);
    CHECK(touched >= changed);
    CHECK(floor.light({lamp(1, {0, 3, 0}, 0), lamp(2, to, 0.5f)}) == 0);
    CHECK(floor.image.version == version + 1);
}

TEST_CASE(
    "light map: lights that come, move and go leave the map of those that are left"
    * technique("light.lightmap")) {
    MappedFloor fresh;
    const PlacedSource first = lamp(1, {0.3f, 0.4f, 0.1f}, 2);
    const PlacedSource second = lamp(2, {-0.3f, 0.6f, 0.5f}, 1.5f, 3);
    fresh.light({first, second});
    MappedFloor used;
    used.light({second});
    used.light({second, lamp(3, {0, 0.5f, 0}, 5)});
    used.light({lamp(3, {0, 0.2f, 0}, 5), lamp(1, {0.9f, 0.4f, 0.9f}, 2), second});
    CHECK(used.image.pixels != fresh.image.pixels);
    used.light({second, first});
    CHECK(used.image.pixels == fresh.image.pixels);
    used.light({});
    for (const float value : {used.red(0), used.red(77), used.red(500)}) {
        CHECK(value == 0);
    }
}

TEST_CASE("light map: spheres of influence find what lights reach") {
    const Bounds box = {{1, -1, -1}, {2, 1, 1}};
    CHECK(reaches(lamp(1, {0, 0, 0}, 1).source, box));
    CHECK(!reaches(lamp(1, {0, 0, 0}, 0.99f).source, box));
    CHECK(!reaches(lamp(1, {0, 2, 0}, 1.4f).source, box));
    CHECK(reaches(lamp(1, {0, 2, 0}, 1.42f).source, box));
    CHECK(reaches(lamp(1, {1.5f, 0, 0}, 0.01f).source, box));
    CHECK(reaches(lamp(1, {99, 0, 0}, 0).source, box));
    CHECK(!reaches(lamp(1, {1.5f, 0, 0}, 1, 0).source, box));
}

TEST_CASE("light map: what is not finite lights nothing") {
    const Affine world = placed({0, std::nanf(""), 0});
    CHECK(light_map_source(PointLight{}, world).color == Vec3(0));
    CHECK(light_map_source(SpotLight{.intensity = INFINITY}, placed({0, 1, 0})).color == Vec3(0));
    CHECK(light_map_source(DirectionalLight{.enabled = false}, placed({0, 1, 0})).color == Vec3(0));
}

namespace {

/// A floor with a box above its middle, and a lamp.
struct MappedRoom {
    World world;
    Entity floor;
    Entity box;
    Entity light;

    explicit MappedRoom(bool shadows = true) {
        register_all_components();
        auto& assets = world.insert_resource(Assets{});
        assets.meshes = {floor_mesh(4), box_mesh({0.5f, 0.1f, 0.5f})};
        assets.materials.resize(1);
        world.insert_resource(LightMapOccluders{});
        floor = world.create(
            MeshInstance{{0}, {0}}, WorldTransform{placed({0, 0, 0})},
            LightMap{.shadows = shadows});
        box = world.create(
            MeshInstance{{1}, {0}}, WorldTransform{placed({0, 0.4f, 0})},
            LightMap{.shadows = shadows});
        light = world.create(
            BakedLight{}, PointLight{.intensity = 1, .radius = 0},
            WorldTransform{placed({0, 1, 0})});
    }
    void step() {
        world.run(add_light_map_states);
        world.run(update_light_maps);
    }
    /// Red at the texel of a mesh that is nearest to a point.
    float red_at(Entity entity, const Vec3& point) {
        const auto& state = world.get<LightMapState>(entity);
        const ImageData& image = world.resource<Assets>().images[state.image.index];
        float value = -1;
        float least = INFINITY;
        for (const LightMapTexel& texel : state.texels) {
            const float distance = glm::distance(texel.position, point);
            if (distance < least) {
                least = distance;
                std::memcpy(&value, &image.pixels[sizeof(Vec4) * texel.pixel], sizeof value);
            }
        }
        return value;
    }
};

}  // namespace

TEST_CASE(
    "light map: meshes get charts, an image and a material, and shadow each other"
    * technique("light.lightmap")) {
    MappedRoom room;
    room.step();
    auto& assets = room.world.resource<Assets>();
    REQUIRE(assets.meshes.size() == 4);
    REQUIRE(assets.images.size() == 2);
    REQUIRE(assets.materials.size() == 3);
    const auto instance = room.world.get<MeshInstance>(room.floor);
    CHECK(instance.mesh.index == 2);
    CHECK(assets.materials[instance.material.index].light_map_texture.image.index == 0);
    CHECK(assets.materials[instance.material.index].light_map_texture.uv_set == 1);
    CHECK(assets.meshes[2].uvs1.size() == assets.meshes[2].positions.size());
    // Beside the box's shadow, which is twice as wide as the box: 1 cd at 1.3 m, and slanted.
    const Vec3 lit = {0.83f, 0, 0};
    const float distance2 = 1 + 0.83f * 0.83f;
    CHECK(
        room.red_at(room.floor, lit) == near(1 / (kPi * std::pow(distance2, 1.5f))).epsilon(0.06));
    CHECK(room.red_at(room.floor, {0.1f, 0, 0.1f}) == 0);
    CHECK(room.red_at(room.box, {0, 0.45f, 0}) > 0.5f);  // its top
    CHECK(room.red_at(room.box, {0, 0.35f, 0}) == 0);

    // Nothing changes where nothing does.
    const std::uint32_t version = assets.images[0].version;
    room.step();
    CHECK(assets.images[0].version == version);
    CHECK(assets.meshes.size() == 4);

    // The box moves away, the light goes out.
    room.world.get<WorldTransform>(room.box).world = placed({3, 0.4f, 0});
    room.step();
    CHECK(room.red_at(room.floor, {0.1f, 0, 0.1f}) > 0.2f);
    room.world.get<PointLight>(room.light).enabled = false;
    room.step();
    CHECK(room.red_at(room.floor, {0.1f, 0, 0.1f}) == 0);
    CHECK(assets.images.size() == 2);
}

TEST_CASE("light map: without shadows light passes through everything") {
    MappedRoom room(false);
    room.step();
    CHECK(room.red_at(room.floor, {0, 0, 0}) == near(1 / kPi).epsilon(0.02));
}

TEST_CASE("light map: a mesh with morph targets has none, and is drawn as it is") {
    MappedRoom room;
    room.world.resource<Assets>().meshes[1].morphs.resize(1);
    room.step();
    room.step();
    CHECK(room.world.get<MeshInstance>(room.box).mesh.index == 1);
    CHECK(room.world.resource<Assets>().images.size() == 1);
    CHECK(room.red_at(room.floor, {0.83f, 0, 0}) > 0.1f);
}

}  // namespace limn::light_map_test
