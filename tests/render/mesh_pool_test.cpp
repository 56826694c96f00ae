#include "ecs/components/shadow.h"
#include "render/geometry/mesh_pool.h"
#include "render/geometry/triangle_order.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <algorithm>
#include <cstring>

namespace limn::test::mesh_pool_test {
namespace {

MeshData make_quads(int count) {
    MeshData mesh;
    for (int i = 0; i < count; ++i) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        const auto x = static_cast<float>(i);
        mesh.positions.insert(
            mesh.positions.end(), {{x, 0, 0}, {x + 1, 0, 0}, {x + 1, 1, 0}, {x, 1, 0}});
        mesh.indices.insert(
            mesh.indices.end(), {first, first + 1, first + 2, first, first + 2, first + 3});
    }
    mesh.normals.assign(mesh.positions.size(), {0, 0, 1});
    mesh.uvs.assign(mesh.positions.size(), {0.25f, 0.75f});
    return mesh;
}

template <typename T>
std::vector<T> read_stream(const MeshPool& pool, VertexStream stream, std::size_t mesh) {
    const MeshRange& range = pool.meshes()[mesh];
    std::vector<T> values(range.vertex_count);
    pool.streams().buffer(stream).read(
        static_cast<std::size_t>(range.base_vertex) * sizeof(T),
        std::as_writable_bytes(std::span(values)));
    return values;
}

}  // namespace

TEST_CASE_FIXTURE(RenderTest, "mesh pool: an edited mesh is uploaded again, others stay") {
    std::vector<MeshData> meshes = {make_quads(2), make_quads(3), make_quads(4)};
    MeshPool pool;
    pool.update(meshes);
    const std::uint64_t revision = pool.revision();
    const std::vector<MeshRange> before = pool.meshes();
    meshes[1].positions[0] = {-5, 0, 0};
    pool.update(meshes);
    CHECK(pool.revision() == revision);  // nobody said that it changed
    ++meshes[1].version;
    pool.update(meshes);
    CHECK(pool.revision() != revision);
    CHECK(pool.meshes()[1].base_vertex == before[1].base_vertex);  // it still fits
    CHECK(read_stream<Vec3>(pool, VertexStream::Position, 1) == meshes[1].positions);
    CHECK(pool.meshes()[1].bounds.min.x == -5);
    for (const std::size_t i : {0, 2}) {
        CHECK(pool.meshes()[i].base_vertex == before[i].base_vertex);
        CHECK(read_stream<Vec3>(pool, VertexStream::Position, i) == meshes[i].positions);
    }
    // A mesh that grew moves to a larger range, and its old one is free.
    meshes[0] = make_quads(5);
    meshes[0].version = 1;
    pool.update(meshes);
    CHECK(pool.used_vertices() == 4 * (5 + 3 + 4));
    CHECK(pool.index_bytes() == 2 * 6 * (5 + 3 + 4));
    CHECK(read_stream<Vec3>(pool, VertexStream::Position, 0) == meshes[0].positions);
    CHECK(read_stream<Vec3>(pool, VertexStream::Position, 2) == meshes[2].positions);
}

TEST_CASE_FIXTURE(RenderTest, "mesh pool: a thousand edits and frees take no additional memory") {
    Assets assets;
    MeshPool pool;
    for (int i = 0; i < 1000; ++i) {
        if (i >= 10) {
            free_mesh(assets, {static_cast<std::uint32_t>(i - 10)});
        }
        assets.meshes.push_back(make_quads(1 + i % 50));
        pool.update(assets.meshes);
    }
    std::size_t vertices = 0;
    for (const MeshData& mesh : assets.meshes) {
        vertices += mesh.positions.size();
    }
    CHECK(pool.used_vertices() == vertices);
    CHECK(pool.streams().capacity() == 1 << 16);  // as at first; all together have 102,000
    CHECK(pool.meshes()[0].index_count == 0);
    CHECK(read_stream<Vec3>(pool, VertexStream::Position, 999) == assets.meshes[999].positions);
}

TEST_CASE_FIXTURE(RenderTest, "mesh pool: growing keeps every stream") {
    std::vector<MeshData> meshes = {make_quads(7)};
    meshes[0].colors.assign(28, {0.5f, 1, 0.25f, 1});
    MeshPool pool;
    pool.update(meshes);
    meshes.push_back(make_quads(20000));  // 80,000 vertices
    pool.update(meshes);
    CHECK(pool.streams().capacity() > 1 << 16);
    CHECK(read_stream<Vec3>(pool, VertexStream::Position, 0) == meshes[0].positions);
    CHECK(read_stream<Vec2>(pool, VertexStream::Uv, 0) == meshes[0].uvs);
    using Color = std::array<std::uint16_t, 4>;
    CHECK(
        read_stream<Color>(pool, VertexStream::Color, 0)
        == std::vector<Color>(28, Color{0x3800, 0x3c00, 0x3400, 0x3c00}));
    CHECK(
        read_stream<Color>(pool, VertexStream::Color, 1)
        == std::vector<Color>(80000, Color{0x3c00, 0x3c00, 0x3c00, 0x3c00}));
}

TEST_CASE_FIXTURE(
    RenderTest, "mesh pool: up to 65,535 vertices an index takes 2 bytes, beyond 4"
                    * technique("engine.compact-data")) {
    const auto with_vertices = [](std::size_t count) {
        MeshData mesh = make_quads(16384);
        mesh.positions.resize(count, {7, 7, 7});
        const auto last = static_cast<std::uint32_t>(count - 1);
        std::erase_if(mesh.indices, [&](std::uint32_t index) { return index >= last; });
        mesh.indices.resize(mesh.indices.size() / 3 * 3 - 3);  // an odd number
        mesh.indices.insert(mesh.indices.end(), {last, 0, 1});
        return mesh;
    };
    const std::vector<MeshData> meshes = {
        make_quads(3), with_vertices(65535), make_quads(2), with_vertices(65536)};
    MeshPool pool;
    pool.update(meshes);
    CHECK_FALSE(pool.meshes()[0].wide);
    CHECK_FALSE(pool.meshes()[1].wide);
    CHECK(pool.meshes()[3].wide);
    std::size_t bytes = 0;
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        CAPTURE(i);
        const MeshRange& range = pool.meshes()[i];
        const std::size_t size = index_size(range.wide);
        std::vector<std::byte> raw(size * range.index_count);
        pool.indices().read(size * range.first_index, std::span(raw));
        std::vector<std::uint32_t> back(range.index_count);
        for (std::size_t k = 0; k < back.size(); ++k) {
            std::memcpy(&back[k], raw.data() + size * k, size);  // little-endian
        }
        CHECK(back == order_for_cache(meshes[i].indices, meshes[i].positions.size()));
        std::size_t count = range.index_count;
        for (const CoarseRange& level : range.coarse) {
            count += level.index_count;
        }
        bytes += (size * count + 3) / 4 * 4;
    }
    CHECK(pool.index_bytes() == bytes);
}

TEST_CASE_FIXTURE(
    RenderTest, "mesh pool: new meshes are ordered for the vertex cache, edited ones are not"
                    * technique("engine.opt-vertex")) {
    std::vector<MeshData> meshes = {make_ball(24)};
    // Triangles in an order that uses no vertex twice in a row.
    std::vector<std::uint32_t>& indices = meshes[0].indices;
    const std::size_t triangles = indices.size() / 3;
    std::vector<std::uint32_t> far(indices.size());
    for (std::size_t i = 0; i < triangles; ++i) {
        const std::size_t other = i * 601 % triangles;
        std::copy_n(
            indices.begin() + static_cast<std::ptrdiff_t>(3 * other), 3,
            far.begin() + static_cast<std::ptrdiff_t>(3 * i));
    }
    indices = far;
    const auto stored = [](const MeshPool& pool) {
        const MeshRange& range = pool.meshes()[0];
        std::vector<std::uint16_t> values(range.index_count);
        pool.indices().read(2 * range.first_index, std::as_writable_bytes(std::span(values)));
        return std::vector<std::uint32_t>(values.begin(), values.end());
    };
    MeshPool pool;
    pool.update(meshes);
    CHECK(stored(pool) != indices);
    CHECK(stored(pool) == order_for_cache(indices, meshes[0].positions.size()));
    ++meshes[0].version;
    pool.update(meshes);
    CHECK(stored(pool) == indices);
}

TEST_CASE_FIXTURE(
    Scene, "mesh pool: meshes with indices of both sizes are drawn, and cast shadows, alike"
               * technique("engine.compact-data")) {
    const MeshData ball = make_ball(32);
    MeshData many = ball;  // the same triangles, and vertices that nothing uses
    many.positions.resize(kMaxShortVertices + 1);
    many.normals.resize(many.positions.size(), Vec3(0, 0, 1));
    many.uvs.resize(ball.uvs.empty() ? 0 : many.positions.size());
    many.tangents.resize(ball.tangents.empty() ? 0 : many.positions.size());
    const Entity sun = shine(
        DirectionalLight{}, affine_from({0, 0, 0}, glm::angleAxis(-0.9f, Vec3(1, 0, 0)), Vec3(1)));
    const MeshId narrow = add(ball);
    const MeshId wide = add(many);
    place(add(make_square()), add(Material{}), at({0, 0, -1}));
    const MaterialId clay = add(Material{.base_color = {0.8f, 0.4f, 0.2f, 1}});
    std::vector<Entity> balls;
    for (int i = 0; i < 9; ++i) {
        const Vec3 position = {
            0.5f * static_cast<float>(i % 3) - 0.5f, 0.5f * static_cast<float>(i / 3) - 0.5f, 0};
        balls.push_back(place(narrow, clay, affine_from(position, {1, 0, 0, 0}, Vec3(0.2f))));
    }
    const RenderView view = look({0, 0, 2}, {0, 0, 0}, 96, 96);
    const gpu::FloatImage unshadowed = radiance(view);
    world.add(sun, Shadow{.resolution = 512});
    const gpu::FloatImage expected = radiance(view);
    CHECK(expected.pixels != unshadowed.pixels);
    CHECK(draw(view).statistics.draws == 1);
    for (std::size_t i = 0; i < balls.size(); i += 2) {
        world.get<MeshInstance>(balls[i]).mesh = wide;
    }
    CHECK(draw(view).statistics.draws == 2);  // one for each size of indices
    CHECK(radiance(view).pixels == expected.pixels);
}

TEST_CASE_FIXTURE(
    RenderTest, "mesh pool: streams exist once a mesh has them, filled with the stand-in values") {
    std::vector<MeshData> meshes = {make_quads(1)};
    MeshPool pool;
    pool.update(meshes);
    CHECK_FALSE(pool.streams().has(VertexStream::Color));
    CHECK_FALSE(pool.streams().has(VertexStream::Uv1));
    meshes.push_back(make_quads(1));
    meshes[1].colors.assign(4, {0, 0, 0, 1});
    meshes[1].uvs1.assign(4, {0.5f, 0.5f});
    pool.update(meshes);
    using Color = std::array<std::uint16_t, 4>;
    CHECK(
        read_stream<Color>(pool, VertexStream::Color, 0)
        == std::vector<Color>(4, Color{0x3c00, 0x3c00, 0x3c00, 0x3c00}));
    CHECK(read_stream<Vec2>(pool, VertexStream::Uv1, 0) == meshes[0].uvs);
    CHECK(read_stream<Vec2>(pool, VertexStream::Uv1, 1) == meshes[1].uvs1);
}

TEST_CASE_FIXTURE(
    Scene, "mesh pool: an edited mesh is drawn as a new one would be, a freed one not") {
    const MeshId ball = add(make_ball(8));
    const MaterialId gray = add(Material{});
    const Entity entity = place(ball, gray, affine_from({0, 0, 0}, {1, 0, 0, 0}, Vec3(0.5f)));
    shine(PointLight{}, affine_from({1, 1, 2}, {1, 0, 0, 0}, Vec3(1)));
    const RenderView view = look({0, 0, 2}, {0, 0, 0}, 64, 64);
    const gpu::FloatImage round = radiance(view);
    auto& assets = world.resource<Assets>();
    MeshData flat = make_ball(8);
    for (Vec3& p : flat.positions) {
        p.y *= 0.5f;
    }
    flat.bounds = {};
    flat.version = assets.meshes[ball.index].version + 1;
    assets.meshes[ball.index] = flat;
    const gpu::FloatImage edited = radiance(view);
    CHECK(edited.pixels != round.pixels);
    world.get<MeshInstance>(entity).mesh = add(flat);
    CHECK(radiance(view).pixels == edited.pixels);
    free_mesh(assets, world.get<MeshInstance>(entity).mesh);
    CHECK(draw(view).statistics.visible_instances == 0);
}

}  // namespace limn::test::mesh_pool_test
