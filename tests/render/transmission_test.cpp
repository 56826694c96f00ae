#include "ecs/base/optics.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

namespace limn::test::transmission_test {
namespace {

/// Clear glass that scatters and, unless said otherwise, absorbs nothing.
Material glass(float thickness, float roughness = 0) {
    return {
        .base_color = {1, 1, 1, 1},
        .roughness = roughness,
        .transmission = 1,
        .thickness = thickness};
}

Material unlit(const Vec3& color) {
    return {.shading = ShadingModel::Unlit, .base_color = Vec4(color, 1)};
}

struct GlassScene : Scene {
    GlassScene() : square(add(make_square())) {}

    /// A white wall left of x = `edge` at depth `z`, black right of it.
    void add_edge(float z, float edge) {
        place(square, add(unlit({1, 1, 1})), affine_from({edge - 5, 0, z}, {1, 0, 0, 0}, Vec3(5)));
        place(square, add(unlit({0, 0, 0})), affine_from({edge + 5, 0, z}, {1, 0, 0, 0}, Vec3(5)));
    }
    Entity add_pane(const Material& material, float scale = 3) {
        return place(square, add(material), affine_from({0, 0, 0}, {1, 0, 0, 0}, Vec3(scale)));
    }
    [[nodiscard]] RenderView front(int size = 64) const {
        return look({0, 0, 2}, {0, 0, 0}, size, size);
    }

    MeshId square;
};

/// Fraction transmitted by glass of index 1.5 at normal incidence.
constexpr float kLetIn = 0.96f;

/// Pixels of a row, from the left, whose mean is what the row has: where an edge is.
float edge_of(const gpu::FloatImage& image, int row, float white) {
    float sum = 0;
    for (int x = 0; x < image.width; ++x) {
        sum += image.at(x, row, 0) / white;
    }
    return sum;
}

/// Pixels of a row between a tenth and nine tenths of `white`.
int width_of_edge(const gpu::FloatImage& image, int row, float white) {
    int count = 0;
    for (int x = 0; x < image.width; ++x) {
        const float fraction = image.at(x, row, 0) / white;
        count += fraction > 0.1f && fraction < 0.9f ? 1 : 0;
    }
    return count;
}

}  // namespace

TEST_CASE_FIXTURE(GlassScene, "transmission: in a furnace clear glass is invisible, rough or not") {
    world.insert_resource(Environment{.sky = SkyKind::Uniform, .zenith = {1, 1, 1}});
    const MeshId ball = add(make_ball(64));
    for (const float roughness : {0.0f, 0.3f, 0.7f}) {
        for (const float thickness : {0.0f, 1.0f}) {
            const Entity entity = place(ball, add(glass(thickness, roughness)), at({0, 0, -1.2f}));
            for (const float value : radiance(look({0, 0, 1}, {0, 0, 0}, 48, 48)).pixels) {
                CHECK(value == near(1).epsilon(0.02));
            }
            world.destroy(entity);
        }
    }
}

TEST_CASE_FIXTURE(
    GlassScene,
    "transmission: the background appears where the ray refracted by Snell's law exits") {
    constexpr float kThickness = 0.5f;
    constexpr float kWall = -0.6f;
    constexpr int kSize = 128;
    const Vec3 eye = {1.2f, 0, 0.9f};
    const RenderView view = look(eye, {0, 0, 0}, kSize, kSize);
    constexpr float kScale = 40;
    Material slab = glass(kThickness / kScale);
    for (const float index : {1.1f, 1.5f, 2.4f}) {
        slab.refractive_index = index;
        world.clear();
        add_edge(kWall, -0.4f);
        add_pane(slab, kScale);
        const gpu::FloatImage image = radiance(view);
        int want = -1;  // the last pixel of the center row that shows the white part
        for (int x = 0; x < kSize; ++x) {
            const float u = (static_cast<float>(x) + 0.5f) / kSize * 2 - 1;
            const Vec3 ray = glm::normalize(
                transform_vector(view.world_from_camera, Vec3(u * view.tangent.x, 0, -1)));
            const Vec3 hit = eye - ray * (eye.z / ray.z);
            const Vec3 leaves = hit + kThickness * refract_ray({0, 0, 1}, -ray, 1 / index);
            const Vec3 seen = leaves - eye;
            if (ray.z < 0 && (eye + seen * ((kWall - eye.z) / seen.z)).x < -0.4f) {
                want = std::max(want, x);
            }
        }
        REQUIRE(want > 4);
        int got = -1;
        for (int x = 0; x < kSize; ++x) {
            if (image.at(x, kSize / 2, 0) > 0.3f) {
                got = std::max(got, x);
            }
        }
        CAPTURE(index);
        CHECK(std::abs(got - want) <= 1);
    }
}

TEST_CASE_FIXTURE(
    GlassScene, "transmission: a wall within a medium appears where the refracted ray hits it") {
    constexpr double kWall = -0.3;  // as an iris beneath its cornea
    constexpr double kEdge = 0.1;
    constexpr int kSize = 128;
    constexpr float kScale = 40;
    const Vec3 eye = {1.2f, 0, 0.9f};
    const RenderView view = look(eye, {0, 0, 0}, kSize, kSize);
    Material slab = glass(2 / kScale);
    for (const float index : {1.1f, 1.376f, 2.4f}) {
        slab.refractive_index = index;
        world.clear();
        add_edge(static_cast<float>(kWall), static_cast<float>(kEdge));
        add_pane(slab, kScale);
        const gpu::FloatImage image = radiance(view);
        int want = -1;  // the last pixel of the center row that shows the white part
        int straight = -1;
        for (int x = 0; x < kSize; ++x) {
            const float u = (static_cast<float>(x) + 0.5f) / kSize * 2 - 1;
            const glm::dvec3 ray = glm::normalize(glm::dvec3(
                transform_vector(view.world_from_camera, Vec3(u * view.tangent.x, 0, -1))));
            if (ray.z >= 0) {
                continue;
            }
            const double hit = eye.x - ray.x * eye.z / ray.z;
            const double sine = ray.x / index;  // Snell's law, of the angle from the normal z
            want =
                hit - kWall * sine / std::sqrt(1 - sine * sine) < kEdge ? std::max(want, x) : want;
            straight = hit - kWall * ray.x / -ray.z < kEdge ? std::max(straight, x) : straight;
        }
        REQUIRE(std::abs(want - straight) >= 1);
        int got = -1;
        for (int x = 0; x < kSize; ++x) {
            if (image.at(x, kSize / 2, 0) > 0.3f) {
                got = std::max(got, x);
            }
        }
        CAPTURE(index);
        CHECK(std::abs(got - want) <= 1);
    }
}

TEST_CASE_FIXTURE(GlassScene, "transmission: a thin sheet moves nothing and tints by its color") {
    add_edge(-1, 0.3f);
    const gpu::FloatImage bare = radiance(front());
    Material sheet = glass(0);
    sheet.base_color = {0.5f, 0.25f, 1, 1};
    add_pane(sheet);
    const gpu::FloatImage tinted = radiance(front());
    CHECK(edge_of(tinted, 32, 0.5f * kLetIn) == near(edge_of(bare, 32, 1)).epsilon(0.02));
    CHECK(tinted.at(20, 32, 0) == near(0.5f * kLetIn).epsilon(0.01));
    CHECK(tinted.at(20, 32, 1) == near(0.25f * kLetIn).epsilon(0.01));
}

TEST_CASE_FIXTURE(
    GlassScene,
    "transmission: twice the depth squares the transmittance, and scale counts as depth") {
    add_edge(-3, 5);
    const auto seen = [&](float thickness, float scale) {
        Material amber = glass(thickness);
        amber.attenuation_color = {0.5f, 0.8f, 1};
        amber.attenuation_distance = 2;
        const Entity pane = add_pane(amber, scale);
        const Vec3 color = rgb_at(radiance(front()), 32, 32) / kLetIn;
        world.destroy(pane);
        return color;
    };
    CHECK(seen(2, 1).x == near(0.5).epsilon(0.01));
    CHECK(seen(4, 1).x == near(0.25).epsilon(0.01));
    CHECK(seen(2, 2).y == near(0.64).epsilon(0.01));
    CHECK(seen(2, 2).z == near(1).epsilon(0.01));
}

TEST_CASE_FIXTURE(
    GlassScene, "transmission: a thickness map is a factor of the thickness, texel by texel") {
    add_edge(-3, 5);
    Material amber = glass(4);
    amber.attenuation_color = {0.5f, 0.8f, 1};
    amber.attenuation_distance = 2;
    amber.thickness_texture = {
        .image = add(ImageData{
            .name = "thickness",
            .width = 2,
            .height = 1,
            .pixels = {0, 255, 0, 255, 255, 0, 255, 255}}),
        .wrap_u = Wrap::Clamp,
        .nearest = true};
    add_pane(amber, 1);
    const gpu::FloatImage image = radiance(front());
    const Vec3 thick = rgb_at(image, 24, 32) / kLetIn;
    const Vec3 thin = rgb_at(image, 40, 32) / kLetIn;
    CHECK(thick.x == near(0.25).epsilon(0.01));
    CHECK(thick.y == near(0.64).epsilon(0.01));
    CHECK(thin.x == near(1).epsilon(0.01));
}

TEST_CASE_FIXTURE(
    GlassScene,
    "transmission: with dispersion each color is bent as by glass of its own refractive index"
        * technique("shade.dispersion")) {
    add_edge(-0.6f, -0.4f);
    const RenderView view = look({1.2f, 0, 0.9f}, {0, 0, 0}, 128, 128);
    constexpr float kScale = 40;
    Material slab = glass(0.5f / kScale);
    const auto seen = [&] {
        const Entity pane = add_pane(slab, kScale);
        const gpu::FloatImage image = radiance(view);
        world.destroy(pane);
        return image;
    };
    const gpu::FloatImage plain = seen();
    slab.dispersion = 4;
    const gpu::FloatImage spread = seen();
    const float half_spread = 0.5f * 0.025f * slab.dispersion;
    slab.dispersion = 0;
    CHECK(seen().pixels == plain.pixels);
    float red_from_blue = 0;
    for (const int channel : {0, 2}) {
        slab.refractive_index = 1.5f + (channel == 0 ? -half_spread : half_spread);
        const gpu::FloatImage bent = seen();
        for (int y = 0; y < 128; ++y) {
            for (int x = 0; x < 128; ++x) {
                // The reflectance of the front is that of the index 1.5 for all colors.
                CHECK(std::abs(spread.at(x, y, channel) - bent.at(x, y, channel)) < 0.02f);
                red_from_blue =
                    std::max(red_from_blue, std::abs(spread.at(x, y, 0) - spread.at(x, y, 2)));
            }
        }
    }
    CHECK(red_from_blue > 0.5f);
}

TEST_CASE_FIXTURE(
    GlassScene, "transmission: rough glass blurs distant surfaces more, and keeps the mean") {
    int before = 0;
    for (const float distance : {0.1f, 0.5f, 2.0f}) {
        world.clear();
        add_edge(-distance, 0);
        add_pane(glass(0, 0.5f));
        const gpu::FloatImage image = radiance(front(256));
        const int width = width_of_edge(image, 128, kLetIn);
        CAPTURE(distance);
        CHECK(width > before);
        CHECK(edge_of(image, 128, kLetIn) == near(128).epsilon(0.03));
        before = width;
    }
}

TEST_CASE_FIXTURE(GlassScene, "transmission: surfaces in front of glass do not appear in it") {
    add_edge(-1, 3);
    const RenderView view = look({1.5f, 0, 1.5f}, {0, 0, 0});
    const auto add_bar = [&] {  // which the slab would show displaced
        return place(
            square, add(unlit({0, 0, 0})),
            affine_from({0, 0, 0.2f}, {1, 0, 0, 0}, Vec3(0.3f, 2, 1)));
    };
    const Entity bar = add_bar();
    const gpu::FloatImage clear = radiance(view);
    world.destroy(bar);
    add_pane(glass(0.02f), 40);
    const gpu::FloatImage bare = radiance(view);
    add_bar();
    const gpu::FloatImage barred = radiance(view);
    int hidden = 0;
    int darkened = 0;
    for (int x = 0; x < 64; ++x) {
        const bool is_bar = clear.at(x, 32, 0) == 0 && bare.at(x, 32, 0) > 0.5f;
        hidden += is_bar ? 1 : 0;
        darkened += !is_bar && barred.at(x, 32, 0) < 0.9f * bare.at(x, 32, 0) ? 1 : 0;
    }
    CHECK(hidden > 5);
    CHECK(darkened <= 1);  // beside its edge
}

TEST_CASE_FIXTURE(GlassScene, "transmission: the near side of a double-sided ball is drawn") {
    add_edge(-3, 0.2f);
    const MeshId ball = add(make_ball());
    Material one = glass(1);
    Material two = one;
    two.double_sided = true;
    const Entity first = place(ball, add(one), at({0, 0, 0}));
    const gpu::FloatImage want = radiance(front());
    world.destroy(first);
    place(ball, add(two), at({0, 0, 0}));
    CHECK(largest_difference(radiance(front()), want) < 0.01f);
}

TEST_CASE_FIXTURE(
    GlassScene,
    "transmission: a map is a factor: where it is 0 the surface is opaque, as without") {
    add_edge(-1, 3);  // white
    Material half_clear = {.base_color = {0.5f, 0.25f, 1, 1}, .roughness = 0, .transmission = 1};
    half_clear.transmission_texture = {
        .image = add(ImageData{
            .name = "transmission",
            .width = 2,
            .height = 1,
            .pixels = {0, 255, 255, 255, 255, 0, 0, 255}}),
        .wrap_u = Wrap::Clamp,
        .nearest = true};
    shine(PointLight{.intensity = 4, .radius = 0}, at({0, 0.5f, 1.5f}));
    const Entity pane = add_pane(half_clear);
    const gpu::FloatImage image = radiance(front());
    world.destroy(pane);
    Material whole = half_clear;
    whole.transmission_texture = {};
    const Entity clear = add_pane(whole);
    const gpu::FloatImage all_clear = radiance(front());
    world.destroy(clear);
    whole.transmission = 0;
    add_pane(whole);
    const gpu::FloatImage opaque = radiance(front());
    REQUIRE(largest_difference(all_clear, opaque) > 0.1f);
    for (int y = 0; y < 64; y += 9) {
        for (int x = 0; x < 64; x += 3) {
            const Vec3 want = rgb_at(x < 32 ? opaque : all_clear, x, y);
            CHECK(glm::distance(rgb_at(image, x, y), want) < 2e-3f);
        }
    }
}

TEST_CASE_FIXTURE(
    GlassScene, "transmission: of a medium that covers itself only the nearest surface is drawn") {
    add_edge(-3, 5);  // white
    // Two squares, the near one first; one is red, the other green.
    MeshData two = make_square();
    const MeshData one = two;
    for (std::size_t i = 0; i < one.positions.size(); ++i) {
        two.uvs[i] = {0.25f, 0.5f};
        two.positions.push_back(one.positions[i] - Vec3(0, 0, 0.5f));
        two.normals.push_back(one.normals[i]);
        two.tangents.push_back(one.tangents[i]);
        two.uvs.emplace_back(0.75f, 0.5f);
        grow(two.bounds, two.positions.back());
    }
    for (const std::uint32_t index : one.indices) {
        two.indices.push_back(index + 4);
    }
    Material colored = glass(0.5f);
    colored.base_color_texture = {
        .image = add(ImageData{
            .name = "red and green",
            .width = 2,
            .height = 1,
            .pixels = {255, 0, 0, 255, 0, 255, 0, 255}}),
        .nearest = true};
    const MeshId mesh = add(std::move(two));
    for (const bool double_sided : {false, true}) {
        CAPTURE(double_sided);
        colored.double_sided = double_sided;
        const Entity pane = place(mesh, add(colored), at({0, 0, 0}));
        const Vec3 seen = rgb_at(radiance(look({0, 0, 2}, {0, 0, 0})), 32, 32);
        CHECK(seen.x == near(kLetIn).epsilon(0.01));
        CHECK(seen.y < 0.01f);
        world.destroy(pane);
    }
}

}  // namespace limn::test::transmission_test
