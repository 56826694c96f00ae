// clang-format off: gcc 12 crashes on component_id<WorldTransform> when the fixture is not the first include
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"
// clang-format on
#include "ecs/components/rendering.h"
#include "render/environment/environment_light.h"
#include "tests/render/shader_eval.h"

#include <glm/geometric.hpp>

#include <random>

// What a mirror shows: the surroundings along the reflected ray (env.reflect), where a map says so
// (env.control-map).

namespace limn::test::env_reflect_test {
namespace {

using DVec3 = glm::dvec3;

const Material kMirror = {.base_color = {1, 1, 1, 1}, .metalness = 1, .roughness = 0};
const Environment kSky = {
    .sky = SkyKind::Gradient,
    .zenith = {0.1f, 0.3f, 0.9f},
    .horizon = {0.9f, 0.7f, 0.4f},
    .ground = {0.2f, 0.1f, 0.05f},
    .visible = false};

DVec3 reflected(const DVec3& v, const DVec3& n) {
    return v - 2.0 * n * glm::dot(v, n);
}

/// A square and a material to draw with.
struct MirrorScene : Scene {
    MirrorScene() { world.insert_resource(kSky); }
    Entity ball(const Affine& pose) { return place(sphere, mirror, pose); }
    const MeshId sphere = add(make_ball(96));
    const MaterialId mirror = add(kMirror);
};

/// Largest difference of what a mirror shows from the sky along the ray reflected about
/// normal(point), over the pixels that show it.
template <typename Normal>
double worst_reflection(MirrorScene& scene, const Vec3& eye, Normal&& normal) {
    constexpr int kSide = 96;
    const RenderView view = scene.look(eye, {0, 0, 0}, kSide, kSide);
    const gpu::FloatImage image = scene.radiance(view);
    const gpu::FloatImage depth = scene.aov(view, "depth");
    const layout::EnvironmentBlock sky = make_environment_block(kSky, Vec3(0, 1, 0), Vec3(0));
    const auto& r = view.world_from_camera.row;
    double worst = 0;
    int visible = 0;
    for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
            const float d = depth.at(x, y, 0);
            if (d == kNoDepth) {
                continue;
            }
            const Vec3 in_view = {
                ((static_cast<float>(x) + 0.5f) * 2 / kSide - 1) * view.tangent.x * d,
                (1 - (static_cast<float>(y) + 0.5f) * 2 / kSide) * view.tangent.y * d, -d};
            const DVec3 p = transform_point({{r[0], r[1], r[2]}}, in_view);
            const DVec3 n = normal(p);
            const DVec3 v = p - DVec3(eye);
            const DVec3 direction = glm::normalize(reflected(v, n));
            // At the rim a pixel sees much of the sky; at the horizon the sky has an edge.
            if (glm::dot(n, -glm::normalize(v)) < 0.3 || std::abs(direction.y) < 0.08) {
                continue;
            }
            const Vec3 want = sky_radiance(sky, Vec3(direction));
            worst = std::max<double>(worst, glm::distance(rgb_at(image, x, y), want));
            ++visible;
        }
    }
    REQUIRE(visible > 300);
    return worst;
}

}  // namespace

TEST_CASE_FIXTURE(
    RenderTest,
    "env_reflect: the shader's reflection is V - 2 N (V.N)" * technique("env.reflect")) {
    std::mt19937 random(5);
    std::normal_distribution<float> normal;
    const auto draw = [&] { return Vec3(normal(random), normal(random), normal(random)); };
    const float s = std::sqrt(0.5f);
    std::vector<Vec4> inputs = {
        {s, -s, 0, 0}, {0, 1, 0, 0}, {-0.6f, 0, -0.8f, 0}, {0.6f, 0, 0.8f, 0}};
    for (int i = 0; i < 500; ++i) {
        inputs.emplace_back(draw(), 0);
        inputs.emplace_back(glm::normalize(draw()), 0);
    }
    const std::vector<Vec4> outputs = evaluate_shader(
        "", "if (i % 2u == 0u) { y.xyz = reflect(x.xyz, inputs[i + 1u].xyz); }", inputs);
    CHECK(glm::distance(Vec3(outputs[0]), Vec3(s, s, 0)) < 1e-6f);
    CHECK(glm::distance(Vec3(outputs[2]), Vec3(0.6f, 0, 0.8f)) < 1e-6f);  // head on: the normal
    for (std::size_t i = 0; i < inputs.size(); i += 2) {
        const DVec3 v = Vec3(inputs[i]);
        const DVec3 n = Vec3(inputs[i + 1]);
        const DVec3 r = Vec3(outputs[i]);
        CHECK(glm::distance(r, reflected(v, n)) < 2e-6);
        CHECK(std::abs(glm::length(r) - glm::length(v)) < 2e-6);
        CHECK(std::abs(glm::dot(r, n) + glm::dot(v, n)) < 2e-6);
    }
}

TEST_CASE_FIXTURE(
    MirrorScene, "env_reflect: every pixel of a mirror shows the sky along its reflected ray"
                     * technique("env.reflect")) {
    ball(at({0, 0, 0}));
    for (const Vec3& eye : {Vec3(0, 0, 2.2f), Vec3(1.3f, 1.1f, -1.4f), Vec3(-0.5f, -1.9f, 0.9f)}) {
        CHECK(
            worst_reflection(*this, eye, [](const DVec3& p) { return glm::normalize(p); }) < 0.03);
    }
}

TEST_CASE_FIXTURE(
    MirrorScene, "env_reflect: a stretched, rotated ball reflects by the normals of the ellipsoid"
                     * technique("env.reflect")) {
    const Affine pose = affine_from(
        {0, 0, 0}, glm::angleAxis(0.7f, glm::normalize(Vec3(1, 2, 3))), {1.3f, 0.6f, -0.9f});
    ball(pose);
    const glm::dmat4 inverse = glm::inverse(glm::dmat4(to_mat4(pose)));
    const glm::dmat3 inverse_transpose = glm::transpose(glm::dmat3(inverse));
    const auto normal = [&](const DVec3& p) {
        return glm::normalize(inverse_transpose * DVec3(inverse * glm::dvec4(p, 1)));
    };
    CHECK(worst_reflection(*this, {0, 0, 2.2f}, normal) < 0.05);
    CHECK(worst_reflection(*this, {1.3f, 1.1f, -1.4f}, normal) < 0.05);
}

TEST_CASE_FIXTURE(
    MirrorScene,
    "env_reflect: the reflection does not rotate with the mirror" * technique("env.reflect")) {
    const Entity entity = ball(at({0, 0, 0}));
    const RenderView view = look({0.3f, 0.8f, 2}, {0, 0, 0}, 96, 96);
    const gpu::FloatImage still = radiance(view);
    const Affine turned =
        affine_from({0, 0, 0}, glm::angleAxis(1.3f, glm::normalize(Vec3(0, 1, 0))), {1, 1, 1});
    world.get<WorldTransform>(entity).world = turned;
    world.get<PreviousWorldTransform>(entity).world = turned;
    const gpu::FloatImage image = radiance(view);
    double sum = 0;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        sum += std::abs(image.pixels[i] - still.pixels[i]);
    }
    CHECK(sum / static_cast<double>(image.pixels.size()) < 0.003);
}

TEST_CASE_FIXTURE(
    MirrorScene, "env_reflect: moving the eye along a ray does not change its reflection"
                     * technique("env.reflect")) {
    place(add(make_square()), mirror, affine_from({0, 0, 0}, {1, 0, 0, 0}, {9, 9, 1}));
    const Vec3 toward_eye = {0.4f, 1.1f, 1.0f};
    const auto center_color = [&](float distance) {
        return rgb_at(radiance(look(distance * toward_eye, {0, 0, 0}, 9, 9)), 4, 4);
    };
    CHECK(glm::distance(center_color(1), center_color(2)) < 1e-4f);
    CHECK(glm::distance(center_color(1), center_color(5)) < 1e-4f);
    CHECK(
        glm::distance(center_color(1), rgb_at(radiance(look({0, -1, 1}, {0, 0, 0}, 9, 9)), 4, 4))
        > 0.1f);
}

// ---- where a map says so ---------------------------------------------------------------------

namespace {

const Vec3 kAround = {0.25f, 0.5f, 1.0f};

struct ControlScene : Scene {
    ControlScene() {
        world.insert_resource(
            Environment{.sky = SkyKind::Uniform, .zenith = kAround, .visible = false});
        place(add(make_square()), add(Material{}), at({0, 0, 0}));
    }
    gpu::FloatImage picture(const Material& material) {
        auto& assets = world.resource<Assets>();
        assets.materials[0] = material;
        ++assets.material_version;
        return radiance(look({0, 0, 1}, {0, 0, 0}, 16, 16));
    }
};

/// Two halves: left `left`, right `right` in every channel.
ImageData halves(std::uint8_t left, std::uint8_t right) {
    ImageData image = {.name = "halves", .width = 2, .height = 1, .pixels = {}};
    for (const std::uint8_t value : {left, right}) {
        image.pixels.insert(image.pixels.end(), {value, value, value, 255});
    }
    return image;
}

TextureSlot nearest(ImageId image) {
    TextureSlot slot;
    slot.image = image;
    slot.nearest = true;
    slot.wrap_u = Wrap::Clamp;
    slot.wrap_v = Wrap::Clamp;
    return slot;
}

}  // namespace

TEST_CASE_FIXTURE(
    ControlScene, "env_control_map: unlit, a fraction r of the color is replaced by the reflection"
                      * technique("env.control-map")) {
    const Vec3 own = {0.8f, 0.6f, 0.1f};
    for (const AlphaMode mode : {AlphaMode::Opaque, AlphaMode::Blend}) {
        for (const float r : {0.0f, 0.125f, 0.25f, 0.5f, 0.75f, 1.0f}) {
            const gpu::FloatImage image = picture(
                {.shading = ShadingModel::Unlit,
                 .alpha_mode = mode,
                 .base_color = Vec4(own, 1),
                 .metalness = r,
                 .roughness = 0});
            const Vec3 want = (1 - r) * own + r * kAround;
            CAPTURE(r);
            for (int c = 0; c < 3; ++c) {
                CHECK(std::abs(image.at(5, 9, c) - want[c]) < 0.5f / 255);
            }
        }
    }
}

TEST_CASE_FIXTURE(
    ControlScene, "env_control_map: the image is the same with every light method"
                      * technique("env.control-map")) {
    const Material material = {
        .shading = ShadingModel::Unlit,
        .base_color = {0.8f, 0.6f, 0.1f, 1},
        .metalness = 0.5f,
        .roughness = 0};
    const Vec3 want = 0.5f * Vec3(material.base_color) + 0.5f * kAround;
    shine(PointLight{.intensity = 50}, at({0.3f, 0.4f, 0.8f}));  // which lights it not
    for (int method = 0; method < kLightMethods; ++method) {
        CAPTURE(method);
        world.insert_resource(Rendering{.lights = static_cast<LightMethod>(method)});
        CHECK(glm::distance(rgb_at(picture(material), 5, 9), want) < 3e-3f);
    }
    world.insert_resource(Rendering{.shading = ShadingRate::Vertex});
    CHECK(glm::distance(rgb_at(picture(material), 5, 9), want) < 3e-3f);
}

TEST_CASE_FIXTURE(
    ControlScene, "env_control_map: the map is data: its halves are two materials in one draw call"
                      * technique("env.control-map")) {
    Material material = {
        .shading = ShadingModel::Unlit,
        .base_color = {0.8f, 0.6f, 0.1f, 1},
        .metalness = 1,
        .roughness = 1};  // the map's green, 0 where it does not mirror
    material.metal_rough_texture = nearest(add(halves(0, 255)));
    const gpu::FloatImage image = picture(material);
    CHECK(glm::distance(rgb_at(image, 2, 8), Vec3(material.base_color)) < 2e-3f);
    CHECK(glm::distance(rgb_at(image, 13, 8), kAround) < 2e-3f);
    CHECK(draw(look({0, 0, 1}, {0, 0, 0}, 16, 16)).statistics.draws == 1);
    // Halfway is halfway: no sRGB.
    material.metal_rough_texture = nearest(add(halves(51, 128)));
    const gpu::FloatImage shares = picture(material);
    for (const auto& [x, r] : {std::pair(2, 0.2f), std::pair(13, 128 / 255.0f)}) {
        const Vec3 want = (1 - r) * Vec3(material.base_color) + r * kAround;
        CHECK(glm::distance(rgb_at(shares, x, 8), want) < 3e-3f);
    }
}

TEST_CASE_FIXTURE(
    ControlScene,
    "env_control_map: lit, metalness m is linear between 0 and 1" * technique("env.control-map")) {
    shine(PointLight{.intensity = 2}, at({0.3f, 0.4f, 0.8f}));
    for (const float roughness : {0.1f, 0.5f, 1.0f}) {
        Material material = {.base_color = {0.8f, 0.6f, 0.1f, 1}, .roughness = roughness};
        const gpu::FloatImage without = picture(material);
        material.metalness = 1;
        const gpu::FloatImage all = picture(material);
        CHECK(largest_difference(without, all) > 0.1f);
        // Stored in 127 steps.
        for (const float m : {32.0f / 127, 64.0f / 127, 100.0f / 127}) {
            material.metalness = m;
            const gpu::FloatImage some = picture(material);
            float worst = 0;
            for (std::size_t i = 0; i < some.pixels.size(); ++i) {
                const float want = (1 - m) * without.pixels[i] + m * all.pixels[i];
                worst = std::max(worst, std::abs(some.pixels[i] - want) / std::max(want, 1.0f));
            }
            CAPTURE(roughness);
            CAPTURE(m);
            CHECK(worst < 0.5f / 255);
        }
    }
}

TEST_CASE_FIXTURE(
    ControlScene, "env_control_map: head on, a dielectric reflects 4 % and a metal everything"
                      * technique("env.control-map")) {
    // Head on a dielectric mirrors 4 %; of the rest it is the color.
    const gpu::FloatImage without =
        picture({.base_color = {0.8f, 0.6f, 0.1f, 1}, .metalness = 0, .roughness = 0});
    const gpu::FloatImage all =
        picture({.base_color = {1, 1, 1, 1}, .metalness = 1, .roughness = 0});
    const Vec3 want = (0.96f * Vec3(0.8f, 0.6f, 0.1f) + 0.04f) * kAround;
    CHECK(glm::distance(rgb_at(without, 8, 8), want) < 5e-3f);
    CHECK(glm::distance(rgb_at(all, 8, 8), kAround) < 2e-3f);
}

}  // namespace limn::test::env_reflect_test
