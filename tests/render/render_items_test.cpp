#include "content/make/models/shapes.h"
#include "ecs/components/shadow.h"
#include "ecs/world.h"
#include "render/geometry/instance_list.h"
#include "render/geometry/mesh_pool.h"
#include "render/geometry/render_items.h"
#include "render/gpu/ring_buffer.h"
#include "render/material/material_pool.h"
#include "render/skinning/deformed_list.h"
#include "tests/near.h"
#include "tests/render/render_fixture.h"

#include <algorithm>
#include <functional>
#include <optional>

namespace limn::test::render_items_test {
namespace {

/// 3000 triangles, moved by update_transforms and not: blocks of 1024, 1024, 952 and the moving 2.
struct ItemsTest : RenderTest {
    ItemsTest() {
        MeshData triangle;
        triangle.positions = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
        triangle.indices = {0, 1, 2};
        assets.meshes = {triangle, triangle, {}};
        assets.meshes[1].positions[2].y = 3;
        assets.materials.resize(2);
        assets.materials[1].alpha_mode = AlphaMode::Blend;
        meshes.update(assets.meshes);
        materials.update(assets, true);
        fill(world);
    }
    void fill(World& into) {
        standing.clear();
        for (int i = 0; i < 3000; ++i) {
            standing.push_back(into.create(
                MeshInstance{
                    {static_cast<std::uint32_t>(i) % 3}, {static_cast<std::uint32_t>(i) % 2}},
                WorldTransform{affine_from({i, 0, 0}, {1, 0, 0, 0}, {1, i % 5 == 0 ? -1 : 1, 1})}));
        }
        for (int i = 0; i < 2; ++i) {
            moving.push_back(into.create(
                MeshInstance{{0}, {0}},
                WorldTransform{affine_from({0, i, 0}, {1, 0, 0, 0}, Vec3(1))},
                PreviousWorldTransform{affine_from({0, -i, 0}, {1, 0, 0, 0}, Vec3(1))}));
        }
    }
    void update(World& from, float alpha = 1) {
        items.update(from, meshes, materials, shapes, alpha);
        items.hash_casters();
    }
    /// Draws of all shadow casters.
    std::vector<DrawCommand> collect() {
        gpu::RingBuffer ring(device().caps(), "test", 1 << 20);
        ring.begin_frame();
        InstanceCollector collector;
        InstanceList list;
        collector.collect_casters(items, {.frustum = kEverywhere}, ring, list);
        ring.end_frame();
        return {list.command_values.begin(), list.command_values.end()};
    }
    /// Whether the items are what they would be if nothing had been kept.
    [[nodiscard]] bool is_fresh(World& from, float alpha = 1) {
        RenderItems fresh;
        fresh.update(from, meshes, materials, shapes, alpha);
        fresh.hash_casters();
        bool same = fresh.size() == items.size() && fresh.block_count() == items.block_count();
        for (std::size_t b = 0; same && b < fresh.block_count(); ++b) {
            const RenderItemBlock& want = fresh.block(b);
            const RenderItemBlock& got = items.block(b);
            same = got.size() == want.size() && got.casts_shadows == want.casts_shadows
                   && std::equal(got.entities.begin(), got.entities.end(), want.entities.begin());
            for (std::uint32_t i = 0; same && i < want.size(); ++i) {
                const Bounds a = got.box(i);
                const Bounds w = want.box(i);
                same = a.min == w.min && a.max == w.max && got.keys[i] == want.keys[i]
                       && (!want.casts_shadows || got.caster_hashes[i] == want.caster_hashes[i]);
            }
        }
        return same;
    }

    Assets assets;
    World world;
    std::vector<Entity> standing;
    std::vector<Entity> moving;
    MeshPool meshes;
    MaterialPool materials{device(), 1};
    DeformedList shapes{1 << 27};
    RenderItems items;
};

}  // namespace

TEST_CASE_FIXTURE(ItemsTest, "render items: every mesh instance once, with its box and its state") {
    update(world);
    CHECK(items.size() == 3002);
    CHECK(items.refreshed() == 4);
    const RenderItemBlock& block = items.block(0);
    CHECK(block.size() == 1024);
    CHECK(block.box(4).min == Vec3(3, -1, 0));  // the tall triangle
    CHECK(block.box(4).max == Vec3(5, 3, 0));
    CHECK_FALSE(block.is_drawable(5));  // without triangles
    CHECK(block.is_drawable(6));
    CHECK(draw_state(block.keys[10]).mirrored);
    CHECK_FALSE(draw_state(block.keys[9]).mirrored);
    CHECK(is_blended(block.keys[1]));
    CHECK(block.caster_hashes[1] == 0);
    CHECK(block.caster_hashes[0] != 0);
    CHECK(block.caster_hashes[0] != block.caster_hashes[6]);  // elsewhere
}

TEST_CASE_FIXTURE(ItemsTest, "render items: a draw key preserves the draw state") {
    for (int bits = 0; bits < 128; ++bits) {
        const DrawState state = {
            .blended = (bits & 1) != 0,
            .inflated = (bits & 2) != 0,
            .deformed = (bits & 4) != 0,
            .shell = (bits & 8) != 0,
            .fin = (bits & 16) != 0,
            .mirrored = (bits & 32) != 0,
            .wide = (bits & 64) != 0,
            .batch = 0x01bcdef1,
            .level = 5,
            .index = 0x1edcba98};
        const DrawState back = draw_state(make_draw_key(state));
        CHECK(back.blended == state.blended);
        CHECK(back.inflated == state.inflated);
        CHECK(back.deformed == state.deformed);
        CHECK(back.shell == state.shell);
        CHECK(back.fin == state.fin);
        CHECK(back.mirrored == state.mirrored);
        CHECK(back.wide == state.wide);
        CHECK(back.batch == state.batch);
        CHECK(back.level == state.level);
        CHECK(back.index == state.index);
    }
}

TEST_CASE_FIXTURE(ItemsTest, "render items: only blocks that changed are read again") {
    update(world);
    update(world);
    CHECK(items.refreshed() == 0);
    const auto refreshed_after = [&](const std::function<void()>& change) {
        change();
        update(world);
        CHECK(is_fresh(world));
        return items.refreshed();
    };
    CHECK(
        refreshed_after([&] { world.get<WorldTransform>(standing[2000]).world.row[0].w = -7; })
        == 1);
    CHECK(refreshed_after([&] { world.get<MeshInstance>(standing[5]).material = {1}; }) == 1);
    CHECK(refreshed_after([&] { world.get<MeshInstance>(standing[2999]).mesh = {1}; }) == 1);
    CHECK(refreshed_after([&] { world.destroy(standing[100]); }) >= 1);
    CHECK(refreshed_after([&] { world.add(standing[200], Inflate{0.5f}); }) >= 1);
    CHECK(refreshed_after([&] { world.get<Inflate>(standing[200]).distance = -0.5f; }) == 1);
    CHECK(refreshed_after([&] { world.add(standing[300], NoShadow{}); }) >= 1);
    CHECK(refreshed_after([&] { world.remove<NoShadow>(standing[300]); }) >= 1);
    CHECK(refreshed_after([] {}) == 0);
}

TEST_CASE_FIXTURE(ItemsTest, "render items: other materials or meshes are read again") {
    update(world);
    assets.materials[0].alpha_mode = AlphaMode::Blend;
    ++assets.material_version;
    materials.update(assets, false);
    update(world);
    CHECK(items.refreshed() == 4);
    CHECK(is_fresh(world));
    assets.meshes[2] = assets.meshes[0];
    ++assets.meshes[2].version;
    meshes.update(assets.meshes);
    update(world);
    CHECK(items.block(0).is_drawable(5));
    CHECK(is_fresh(world));
}

TEST_CASE_FIXTURE(
    ItemsTest, "render items: moving items are read at every alpha, items at rest are kept") {
    for (const float alpha : {0.25f, 0.5f, 1.0f}) {
        update(world, alpha);
        CHECK(items.block(3).box(1).min.y == test::near(2 * alpha - 2).scale(1));
        CHECK(is_fresh(world, alpha));
    }
    update(world, 0.5f);
    CHECK(items.refreshed() == 1);  // the moving two
    // At rest the previous matrix has caught up, later than the last change of the current one.
    static_cast<void>(world.version());
    world.query<const WorldTransform, PreviousWorldTransform>().each(
        [](const WorldTransform& now, PreviousWorldTransform& before) {
            before.world = now.world;
        });
    update(world, 0.25f);
    update(world, 0.75f);
    CHECK(items.refreshed() == 0);
    CHECK(is_fresh(world, 0.75f));
}

TEST_CASE_FIXTURE(
    ItemsTest, "render items: a warm-up draws a few triangles and instances of each mesh") {
    assets.meshes.push_back(make_sphere({.radius = 1}));
    meshes.update(assets.meshes);
    world.create(
        MeshInstance{{3}, {0}}, WorldTransform{affine_from({0, 0, 0}, {1, 0, 0, 0}, Vec3(1))});
    update(world);
    const std::vector<DrawCommand> whole = collect();
    items.sampled = true;
    const std::vector<DrawCommand> sample = collect();
    REQUIRE(sample.size() == whole.size());
    for (std::size_t i = 0; i < whole.size(); ++i) {
        CHECK(sample[i].count == std::min(whole[i].count, 192u));
        CHECK(sample[i].instance_count == std::min(whole[i].instance_count, 64u));
        CHECK(sample[i].first_index == whole[i].first_index);
        CHECK(sample[i].base_instance == whole[i].base_instance);
    }
}

TEST_CASE_FIXTURE(ItemsTest, "render items: a new world at the address of an old one is read") {
    // Its archetype may be where that of the old one was, too.
    std::optional<World> other;
    for (int i = 0; i < 20; ++i) {
        other.emplace();
        const auto x = static_cast<float>(10 * i);
        other->create(
            MeshInstance{{0}, {0}}, WorldTransform{affine_from({x, 0, 0}, {1, 0, 0, 0}, Vec3(1))});
        update(*other);
        CHECK(items.block(0).box(0).min.x == x - 1);
    }
}

}  // namespace limn::test::render_items_test
