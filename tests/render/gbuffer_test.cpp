#include "render/graph/frame_graph.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/render/shader_eval.h"
#include "tests/technique.h"

#include <glm/geometric.hpp>

#include <array>

namespace limn::test::gbuffer_test {
namespace {

Quat turn(const Vec3& axis, float degrees_about) {
    return glm::angleAxis(radians(degrees_about), glm::normalize(axis));
}

/// An image of one color everywhere.
ImageData plain_image(std::array<std::uint8_t, 4> color, int side = 2) {
    ImageData image = {.name = "plain", .width = side, .height = side, .pixels = {}};
    for (int i = 0; i < side * side; ++i) {
        image.pixels.insert(image.pixels.end(), color.begin(), color.end());
    }
    return image;
}

/// Four texels: red green / blue white, from the top left.
ImageData quarters() {
    ImageData image = {.name = "quarters", .width = 2, .height = 2, .pixels = {}};
    image.pixels = {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 255, 255};
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

const Vec3 kRed = {1, 0, 0};
const Vec3 kGreen = {0, 1, 0};
const Vec3 kBlue = {0, 0, 1};
const Vec3 kWhite = {1, 1, 1};

/// Pixel of a point of the world, from the top left [px].
Vec2 project(const RenderView& view, const Mat4& clip_from_world, const Vec3& p) {
    const Vec4 clip = clip_from_world * Vec4(p, 1);
    return {
        (clip.x / clip.w * 0.5f + 0.5f) * static_cast<float>(view.width),
        (0.5f - clip.y / clip.w * 0.5f) * static_cast<float>(view.height)};
}

/// What the surface of a pixel, from the top left, has beside its color; see lib/gbuffer.glsl.
struct StoredFactors {
    float occlusion;
    float roughness;
    float metalness;
};

std::vector<StoredFactors> stored_factors(Scene& scene, const RenderView& view) {
    FrameGraph& graph = frame_graph(shared_renderer());
    graph.keep_named("gbuffer.surface");
    scene.draw(view);
    const gpu::Texture& surface = *graph.texture(graph.find("gbuffer.surface"));
    std::vector<glm::uvec4> texels(static_cast<std::size_t>(view.width * view.height));
    glGetTextureImage(
        surface.id(), 0, GL_RGBA_INTEGER, GL_UNSIGNED_INT,
        static_cast<GLsizei>(texels.size() * sizeof(glm::uvec4)), texels.data());
    graph.forget_named("gbuffer.surface");
    std::vector<StoredFactors> factors;
    for (int y = view.height; y-- > 0;) {  // OpenGL's first row is the bottom one
        for (int x = 0; x < view.width; ++x) {
            const std::uint32_t z = texels[static_cast<std::size_t>(y * view.width + x)].z;
            factors.push_back(
                {static_cast<float>(z & 255u) / 255, static_cast<float>(z >> 8 & 1023u) / 1023,
                 static_cast<float>(z >> 18 & 127u) / 127});
        }
    }
    return factors;
}

Vec2 velocity_at(const gpu::FloatImage& image, int x, int y) {
    return {image.at(x, y, 0), image.at(x, y, 1)};
}

}  // namespace

TEST_CASE_FIXTURE(Scene, "gbuffer: normals of a ball are correct, also stretched or mirrored") {
    const MeshId ball = add(make_ball(64));
    const MaterialId gray = add(Material{});
    for (const Vec3& scale :
         {Vec3(1, 1, 1), Vec3(1.5f, 0.5f, 1), Vec3(-1, 1, 1), Vec3(0.7f, -1.2f, -0.9f),
          Vec3(-1, -1, -1)}) {
        world.clear();
        const Quat rotation = turn({1, 2, 0.5f}, 40);
        const Affine world_from_ball = affine_from({0.2f, 0, 0}, rotation, scale);
        place(ball, gray, world_from_ball);
        const RenderView view = look({0, 0, 2.2f}, {0, 0, 0}, 96, 96);
        const gpu::FloatImage normals = aov(view, "normal");
        const gpu::FloatImage depth = aov(view, "depth");
        const Mat3 inverse_transpose = glm::transpose(glm::inverse(Mat3(to_mat4(world_from_ball))));
        const Mat4 ball_from_world = glm::inverse(to_mat4(world_from_ball));
        int front_normal = 0;
        for (int y = 0; y < 96; y += 3) {
            for (int x = 0; x < 96; x += 3) {
                if (depth.at(x, y, 0) == kNoDepth) {
                    CHECK(rgb_at(normals, x, y) == Vec3(0));
                    continue;
                }
                const Vec2 ndc = {
                    (static_cast<float>(x) + 0.5f) / 48 - 1,
                    1 - (static_cast<float>(y) + 0.5f) / 48};
                const Vec3 p = Vec3(0, 0, 2.2f) + depth.at(x, y, 0) * Vec3(ndc, -1);
                const Vec3 local = Vec3(ball_from_world * Vec4(p, 1));
                CHECK(glm::length(local) == test::near(1).epsilon(4e-3));
                const Vec3 want = glm::normalize(inverse_transpose * local);
                CHECK(glm::dot(want, rgb_at(normals, x, y)) > 0.998f);
                ++front_normal;
            }
        }
        CHECK(front_normal > 30);
    }
}

TEST_CASE_FIXTURE(
    Scene, "gbuffer: depth is reversed and converts back to the distance"
               * technique("deferred.gbuffer")) {
    place(add(make_square()), add(Material{}), at({0, 0, 0}));
    for (const float distance : {0.06f, 1.0f, 30.0f, 1000.0f}) {
        const RenderView view = look({0, 0, distance}, {0, 0, 0}, 9, 9);
        frame_graph(shared_renderer()).keep_named("gbuffer.depth");
        CHECK(aov(view, "depth").at(4, 4, 0) == test::near(distance).epsilon(1e-5));
        FrameGraph& graph = frame_graph(shared_renderer());
        const gpu::FloatImage raw = gpu::read_floats(*graph.texture(graph.find("gbuffer.depth")));
        CHECK(raw.at(4, 4, 0) == test::near(0.05f / distance).epsilon(1e-5));
        graph.forget_named("gbuffer.depth");
    }
    // Nothing there: the far end.
    world.clear();
    CHECK(aov(look({0, 0, 1}, {0, 0, 0}, 9, 9), "depth").at(4, 4, 0) == kNoDepth);
}

TEST_CASE_FIXTURE(
    Scene, "gbuffer: the nearer surface hides the farther, in any order of creation") {
    const MeshId square = add(make_square());
    const MaterialId red =
        add(Material{.shading = ShadingModel::Unlit, .base_color = {1, 0, 0, 1}});
    const MaterialId green =
        add(Material{.shading = ShadingModel::Unlit, .base_color = {0, 1, 0, 1}});
    const RenderView view = look({0, 0, 1}, {0, 0, 0}, 9, 9);
    place(square, red, at({0, 0, 0}));
    place(square, green, at({0, 0, -1}));
    CHECK(rgb_at(radiance(view), 4, 4) == kRed);
    world.clear();
    place(square, green, at({0, 0, -1}));
    place(square, red, at({0, 0, 0}));
    CHECK(rgb_at(radiance(view), 4, 4) == kRed);
}

TEST_CASE_FIXTURE(
    Scene,
    "gbuffer: attributes are read back as they were written" * technique("deferred.gbuffer")) {
    Material material = {
        .base_color = {0.8f, 0.2f, 0.05f, 1}, .metalness = 0.3f, .roughness = 0.7f};
    material.emission = {0.001f, 3.5f, 900};
    place(add(make_square()), add(material), at({0, 0, 0}));
    const RenderView view = look({0, 0, 1}, {0, 0, 0}, 9, 9);
    const Vec3 albedo = rgb_at(aov(view, "albedo"), 4, 4);
    for (int c = 0; c < 3; ++c) {
        CHECK(albedo[c] == test::near(material.base_color[c]).epsilon(2e-3));
    }
    const StoredFactors factors = stored_factors(*this, view)[4 * 9 + 4];
    CHECK(factors.occlusion == 1);
    CHECK(std::abs(factors.roughness - 0.7f) <= 0.5001f / 1023);
    CHECK(std::abs(factors.metalness - 0.3f) <= 0.5001f / 127);
    // A shared exponent and nine bits: up to 1022 in steps of 2, rounded.
    const Vec3 emission = rgb_at(aov(view, "emission"), 4, 4);
    CHECK(emission == Vec3(0, 4, 900));
    CHECK(rgb_at(radiance(view), 4, 4) == emission);

    world.resource<Assets>().materials[0].emission = {1, 0.5f, 0.25f};
    ++world.resource<Assets>().material_version;
    CHECK(rgb_at(aov(view, "emission"), 4, 4) == Vec3(1, 0.5f, 0.25f));
}

TEST_CASE_FIXTURE(
    RenderTest, "gbuffer: each field keeps its precision with any of 15 shading models"
                    * technique("deferred.gbuffer")) {
    // Inputs: model; albedo, of which red is the first number and the others lie elsewhere; the
    // three factors, shifted likewise.
    std::vector<Vec4> inputs;
    for (int model = 1; model < 16; ++model) {
        for (int i = 0; i <= 16; ++i) {
            const auto x = static_cast<float>(i) / 16;
            inputs.emplace_back(static_cast<float>(model), x, 1 - x, std::abs(2 * x - 1));
        }
    }
    const std::string before = "#include \"lib/gbuffer.glsl\"\n"
                               "SurfaceSample stored(vec4 x) {\n"
                               "    SurfaceSample s;\n"
                               "    s.normal_ws = normalize(x.yzw - 0.3);\n"
                               "    s.albedo = x.yzw;\n"
                               "    s.emission = x.wyz;\n"
                               "    s.occlusion = x.y;\n"
                               "    s.roughness = x.z;\n"
                               "    s.metalness = x.w;\n"
                               "    s.material = 0u;\n"
                               "    s.model = uint(x.x);\n"
                               "    return unpack_surface(pack_surface(s));\n"
                               "}\n";
    const std::vector<Vec4> factors = evaluate_shader(
        before,
        "SurfaceSample s = stored(x);"
        "y = vec4(float(s.model), s.occlusion, s.roughness, s.metalness);",
        inputs);
    const std::vector<Vec4> colors = evaluate_shader(
        before,
        "SurfaceSample s = stored(x);"
        "y = vec4(sqrt(s.albedo), distance(s.normal_ws, normalize(x.yzw - 0.3)));",
        inputs);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const Vec4& in = inputs[i];
        CHECK(factors[i].x == in.x);
        CHECK(std::abs(factors[i].y - in.y) <= 0.5001f / 255);
        CHECK(std::abs(factors[i].z - in.z) <= 0.5001f / 1023);
        CHECK(std::abs(factors[i].w - in.w) <= 0.5001f / 127);
        CHECK(std::abs(colors[i].x - std::sqrt(in.y)) <= 0.501f / 2047);
        CHECK(std::abs(colors[i].y - std::sqrt(in.z)) <= 0.501f / 2047);
        CHECK(std::abs(colors[i].z - std::sqrt(in.w)) <= 0.501f / 4095);
        CHECK(colors[i].w < 1e-4f);
    }
}

TEST_CASE_FIXTURE(
    RenderTest, "gbuffer: wrinkled skin stores its smooth normal instead of emission"
                    * technique("wrinkle.compression.bump-blend")) {
    std::vector<Vec4> inputs;
    for (int i = 0; i <= 64; ++i) {
        const float angle = 0.37f * static_cast<float>(i);
        inputs.emplace_back(
            std::cos(angle), std::sin(angle), 0.05f * static_cast<float>(i) - 1.6f,
            static_cast<float>(i) / 64);
    }
    const std::string before = "#define SMOOTH_NORMALS\n#include \"lib/gbuffer.glsl\"\n"
                               "SurfaceSample stored(vec4 x, bool smooth_is_stored) {\n"
                               "    SurfaceSample s;\n"
                               "    s.normal_ws = vec3(0.0, 0.0, 1.0);\n"
                               "    s.albedo = vec3(0.5);\n"
                               "    s.emission = vec3(1.0, 2.0, 3.0);\n"
                               "    s.occlusion = s.roughness = s.metalness = 0.5;\n"
                               "    s.material = 0u;\n"
                               "    s.model = 15u;\n"
                               "    s.smooth_normal_ws = normalize(x.xyz);\n"
                               "    s.bounces = x.w == 0.0;\n"
                               "    s.raised = s.bounces ? 1.0 : x.w;\n"
                               "    s.fades = x.w > 0.5;\n"
                               "    s.bump_shadow = 0u;\n"
                               "    s.smooth_is_stored = smooth_is_stored;\n"
                               "    return unpack_surface(pack_surface(s));\n"
                               "}\n";
    const std::vector<Vec4> found = evaluate_shader(
        before,
        "SurfaceSample s = stored(x, true);"
        "y = vec4(distance(s.smooth_normal_ws, normalize(x.xyz)), s.raised, s.fades, s.emission.x "
        "+ "
        "abs(float(s.model) - 15.0));",
        inputs);
    const std::vector<Vec4> bounces = evaluate_shader(
        before,
        "SurfaceSample s = stored(x, true); y.x = float(s.bounces);"
        "s = stored(x, false); y.y = float(s.bounces);",
        inputs);
    const std::vector<Vec4> without = evaluate_shader(
        before,
        "SurfaceSample s = stored(x, false); y = vec4(s.emission, s.raised + float(s.fades));",
        inputs);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        CHECK(found[i].x < 2.1e-3f);  // sqrt(3) sqrt(6) half steps of 1 / 1023
        const float raised = inputs[i].w > 0 ? inputs[i].w : 1;
        CHECK(std::abs(found[i].y - raised) <= 0.5001f / 511);
        CHECK(bounces[i].x == (inputs[i].w > 0 ? 0 : 1));
        CHECK(bounces[i].y == 0);
        CHECK(found[i].z == (inputs[i].w > 0.5f ? 1 : 0));
        CHECK(found[i].w == 0);
        CHECK(without[i] == Vec4(1, 2, 3, 1));
    }
}

TEST_CASE_FIXTURE(
    Scene,
    "gbuffer: the number of draws does not depend on lights" * technique("deferred.gbuffer")) {
    place(add(make_square()), add(Material{}), at({0, 0, 0}));
    const RenderView view = look({0, 0, 1}, {0, 0, 0}, 9, 9);
    const int dark = draw(view).statistics.draws;
    for (int i = 0; i < 50; ++i) {
        shine(PointLight{}, at({0, 0, 1}));
    }
    CHECK(draw(view).statistics.draws == dark);
}

TEST_CASE_FIXTURE(Scene, "gbuffer: the first row of an image is at v = 0") {
    Material material = {.shading = ShadingModel::Unlit, .base_color = {1, 1, 1, 1}};
    material.base_color_texture = nearest(add(quarters()));
    place(add(make_square()), add(material), at({0, 0, 0}));
    const gpu::FloatImage image = radiance(look({0, 0, 1}, {0, 0, 0}, 8, 8));
    CHECK(rgb_at(image, 1, 1) == kRed);
    CHECK(rgb_at(image, 6, 1) == kGreen);
    CHECK(rgb_at(image, 1, 6) == kBlue);
    CHECK(rgb_at(image, 6, 6) == kWhite);
}

TEST_CASE_FIXTURE(
    Scene, "gbuffer: texture transforms and the second uv set are KHR_texture_transform's") {
    MeshData square = make_square();
    square.uvs1.assign(4, Vec2(0.75f, 0.25f));  // green
    const MeshId mesh = add(square);
    const ImageId image = add(quarters());
    const auto corner_colors = [&](const TextureSlot& slot) {
        world.clear();
        Material material = {.shading = ShadingModel::Unlit, .base_color = {1, 1, 1, 1}};
        material.base_color_texture = slot;
        place(mesh, add(material), at({0, 0, 0}));
        const gpu::FloatImage picture = radiance(look({0, 0, 1}, {0, 0, 0}, 8, 8));
        return std::array{
            rgb_at(picture, 1, 1), rgb_at(picture, 6, 1), rgb_at(picture, 1, 6),
            rgb_at(picture, 6, 6)};
    };
    TextureSlot slot = nearest(image);
    slot.uv_set = 1;
    CHECK(corner_colors(slot) == std::array{kGreen, kGreen, kGreen, kGreen});
    slot = nearest(image);
    slot.scale = {0.5f, 0.5f};
    slot.offset = {0.5f, 0};
    CHECK(corner_colors(slot) == std::array{kGreen, kGreen, kGreen, kGreen});
    // A quarter turn about the origin, brought back into the square: u' = v, v' = 1 - u.
    slot = nearest(image);
    slot.rotation = 0.5f * kPi;
    slot.offset = {0, 1};
    CHECK(corner_colors(slot) == std::array{kBlue, kRed, kWhite, kGreen});
    slot = nearest(image);
    slot.wrap_u = Wrap::Repeat;
    slot.offset = {0.5f, 0};
    CHECK(corner_colors(slot) == std::array{kGreen, kRed, kWhite, kBlue});
    slot.wrap_u = Wrap::Mirror;
    slot.offset = {1, 0};
    CHECK(corner_colors(slot) == std::array{kGreen, kRed, kWhite, kBlue});
}

TEST_CASE_FIXTURE(Scene, "gbuffer: sRGB images are decoded, vertex colors multiply") {
    ImageData image = plain_image({188, 188, 188, 255});
    image.srgb = true;
    Material material = {.base_color = {1, 0.5f, 1, 1}};
    material.base_color_texture.image = add(image);
    MeshData square = make_square();
    square.colors.assign(4, {0.5f, 1, 1, 1});
    place(add(square), add(material), at({0, 0, 0}));
    const Vec3 albedo = rgb_at(aov(look({0, 0, 1}, {0, 0, 0}, 9, 9), "albedo"), 4, 4);
    CHECK(albedo.x == test::near(0.5f * 0.5029f).epsilon(5e-3));
    CHECK(albedo.y == test::near(0.5f * 0.5029f).epsilon(5e-3));
    CHECK(albedo.z == test::near(0.5029f).epsilon(5e-3));
}

TEST_CASE_FIXTURE(Scene, "gbuffer: a missing or broken image is magenta") {
    Material material;
    material.base_color = {1, 1, 1, 1};
    material.base_color_texture.image = {42};
    const MaterialId missing = add(material);
    ImageData cut = plain_image({255, 255, 255, 255});
    cut.pixels.resize(3);
    material.base_color_texture.image = add(cut);
    const MaterialId broken = add(material);
    const MeshId square = add(make_square());
    for (const MaterialId id : {missing, broken}) {
        world.clear();
        place(square, id, at({0, 0, 0}));
        CHECK(rgb_at(aov(look({0, 0, 1}, {0, 0, 0}, 9, 9), "albedo"), 4, 4) == Vec3(1, 0, 1));
    }
}

TEST_CASE_FIXTURE(
    Scene, "gbuffer: a normal map leans along u with red and up the image with green"
               * technique("bump.normal-map, bump.tangent-space")) {
    const MeshId square = add(make_square());
    const auto normal_of = [&](std::array<std::uint8_t, 4> texel, const Affine& place_at,
                               float strength) {
        world.clear();
        Material material;
        material.normal_texture.image = add(plain_image(texel));
        material.normal_scale = strength;
        material.double_sided = true;
        place(square, add(material), place_at);
        return rgb_at(aov(look({0, 0, 1}, {0, 0, 0}, 9, 9), "normal"), 4, 4);
    };
    const Affine upright = at({0, 0, 0});
    const float s = std::sqrt(0.5f);
    // 45 degrees along +u, which is +x of the square.
    CHECK(glm::distance(normal_of({218, 128, 218, 255}, upright, 1), Vec3(s, 0, s)) < 0.01f);
    // Along +v of the tangent frame, up the image: +y.
    CHECK(glm::distance(normal_of({128, 218, 218, 255}, upright, 1), Vec3(0, s, s)) < 0.01f);
    CHECK(glm::distance(normal_of({128, 218, 218, 255}, upright, 0), Vec3(0, 0, 1)) < 0.01f);
    // Turned by a quarter about z, the lean turns with it.
    const Affine turned = affine_from({0, 0, 0}, turn({0, 0, 1}, 90), {1, 1, 1});
    CHECK(glm::distance(normal_of({218, 128, 218, 255}, turned, 1), Vec3(0, s, s)) < 0.01f);
    // Mirrored in x, so is the lean along x, and nothing else.
    const Affine mirrored = affine_from({0, 0, 0}, {1, 0, 0, 0}, {-1, 1, 1});
    CHECK(glm::distance(normal_of({218, 128, 218, 255}, mirrored, 1), Vec3(-s, 0, s)) < 0.01f);
    CHECK(glm::distance(normal_of({128, 218, 218, 255}, mirrored, 1), Vec3(0, s, s)) < 0.01f);
    // From behind, raised detail is hollow: the whole normal is reversed.
    const Affine behind = affine_from({0, 0, 0}, turn({0, 1, 0}, 180), {1, 1, 1});
    CHECK(glm::distance(normal_of({218, 128, 218, 255}, behind, 1), Vec3(s, 0, s)) < 0.01f);
}

TEST_CASE_FIXTURE(
    Scene, "gbuffer: texels are decoded to -1 .. 1 and normalized; 128 is a third of a degree off 0"
               * technique("bump.normal-encoding")) {
    const MeshId square = add(make_square());
    for (const std::array<std::uint8_t, 4>& texel : std::vector<std::array<std::uint8_t, 4>>{
             {128, 128, 255, 255}, {255, 128, 140, 255}, {0, 60, 200, 255}, {90, 0, 255, 255}}) {
        world.clear();
        Material material;
        material.normal_texture.image = add(plain_image(texel));
        place(square, add(material), at({0, 0, 0}));
        const Vec3 n = rgb_at(aov(look({0, 0, 1}, {0, 0, 0}, 9, 9), "normal"), 4, 4);
        const Vec3 decoded = Vec3(texel[0], texel[1], texel[2]) / 255.0f * 2.0f - 1.0f;
        CHECK(glm::length(n) == test::near(1.0f).epsilon(1e-4));
        CHECK(glm::distance(n, glm::normalize(decoded)) < 4e-4f);
        if (texel[0] == 128) {
            CHECK(glm::degrees(std::acos(n.z)) == test::near(0.318f).epsilon(0.05));
        }
    }
}

TEST_CASE_FIXTURE(
    Scene, "gbuffer: a flat normal map changes no light, a tilted one no outline"
               * technique("bump.normal-map")) {
    const MeshId ball = add(make_ball());
    const auto draw_with = [&](const std::array<std::uint8_t, 4>* texel, float light_x,
                               const char* layer) {
        world.clear();
        Material material = {.roughness = 1};
        if (texel != nullptr) {
            material.normal_texture.image = add(plain_image(*texel));
        }
        place(ball, add(material), affine_from({0, 0, 0}, {1, 0, 0, 0}, Vec3(0.5f)));
        shine(DirectionalLight{}, affine_from({0, 0, 0}, turn({0, 1, 0}, light_x), {1, 1, 1}));
        const RenderView view = look({0, 0, 1.5f}, {0, 0, 0}, 33, 33);
        return layer == nullptr ? radiance(view) : aov(view, layer);
    };
    const std::array<std::uint8_t, 4> flat = {128, 128, 255, 255};
    const std::array<std::uint8_t, 4> right = {200, 128, 232, 255};
    const std::array<std::uint8_t, 4> left = {56, 128, 232, 255};
    const gpu::FloatImage plain = draw_with(nullptr, 30, nullptr);
    const float brightest = rgb_at(plain, 20, 16).x;
    // Bytes make it lean by 0.0055.
    CHECK(largest_difference(draw_with(&flat, 30, nullptr), plain) < 0.0056f * brightest);
    CHECK(largest_difference(draw_with(&right, 30, nullptr), plain) > 0.1f * brightest);
    CHECK(largest_difference(draw_with(&right, 30, "depth"), draw_with(nullptr, 30, "depth")) == 0);

    // Turned by half a turn, it leans to the other side: lit from there, it is as bright.
    const auto center = [&](const std::array<std::uint8_t, 4>& texel, float light_x) {
        return rgb_at(draw_with(&texel, light_x, nullptr), 16, 16).x;
    };
    CHECK(center(right, 30) == test::near(center(left, -30)).epsilon(0.02));
    CHECK(center(right, -30) == test::near(center(left, 30)).epsilon(0.02));
    CHECK(center(right, 30) > 1.5f * center(left, 30));
}

TEST_CASE_FIXTURE(
    Scene, "derivatives: a normal map widens the lobe by how much it varies between pixels"
               * technique("shade.derivatives")) {
    constexpr int kTexels = 16;  // and pixels
    constexpr float kRoughness = 0.3f;
    const MeshId square = add(make_square());
    const RenderView view = look({0, 0, 1}, {0, 0, 0}, kTexels, kTexels);
    const auto normal_of = [](std::uint8_t red) {
        const auto decoded = [](int byte) { return static_cast<float>(byte) / 255 * 2 - 1; };
        return glm::normalize(Vec3(decoded(red), decoded(128), decoded(255)));
    };
    for (const std::uint8_t red :
         {std::uint8_t{148}, std::uint8_t{255}}) {  // a little, and more than counts
        const float change2 =
            glm::dot(normal_of(red) - normal_of(128), normal_of(red) - normal_of(128));
        // Even; stripes; a chessboard, which changes along x and along y.
        for (const auto& [along_x, along_y] :
             {std::pair(0, 0), std::pair(1, 0), std::pair(0, 1), std::pair(1, 1)}) {
            ImageData image = {.name = "bumps", .width = kTexels, .height = kTexels, .pixels = {}};
            for (int i = 0; i < kTexels * kTexels; ++i) {
                const bool bump = (i % kTexels * along_x + i / kTexels * along_y) % 2 != 0;
                const std::uint8_t texel = bump ? red : std::uint8_t{128};
                image.pixels.insert(image.pixels.end(), {texel, 128, 255, 255});
            }
            world.clear();
            Material material = {.roughness = kRoughness};
            material.normal_texture = nearest(add(std::move(image)));
            place(square, add(material), at({0, 0, 0}));
            const auto changes = static_cast<float>(along_x + along_y);
            const float widened = std::min(2 * 0.159f * changes * change2, 0.18f);
            const float want = std::pow(std::pow(kRoughness, 4.0f) + widened, 0.25f);
            CAPTURE(red);
            CAPTURE(changes);
            for (const StoredFactors& factors : stored_factors(*this, view)) {
                CHECK(std::abs(factors.roughness - want) <= 0.6f / 1023);
            }
        }
    }
}

TEST_CASE_FIXTURE(
    Scene, "gbuffer: back faces are visible only with double-sided materials, mirrored or not") {
    const MeshId square = add(make_square());
    const MaterialId one = add(Material{});
    const MaterialId both = add(Material{.double_sided = true});
    const auto front_normal = [&](MaterialId material, float turn_deg, float scale_x) {
        world.clear();
        place(square, material, affine_from({0, 0, 0}, turn({0, 1, 0}, turn_deg), {scale_x, 1, 1}));
        return rgb_at(aov(look({0, 0, 1}, {0, 0, 0}, 9, 9), "normal"), 4, 4);
    };
    for (const float scale : {1.0f, -1.0f}) {
        CHECK(glm::distance(front_normal(one, 0, scale), Vec3(0, 0, 1)) < 1e-3f);
        CHECK(front_normal(one, 180, scale) == Vec3(0));
        CHECK(glm::distance(front_normal(both, 0, scale), Vec3(0, 0, 1)) < 1e-3f);
        CHECK(glm::distance(front_normal(both, 180, scale), Vec3(0, 0, 1)) < 1e-3f);
    }
}

TEST_CASE_FIXTURE(Scene, "gbuffer: below the cutoff a masked material is a hole") {
    ImageData image = quarters();
    image.pixels[3] = 100;  // red: 0.39
    Material material = {
        .shading = ShadingModel::Unlit, .alpha_mode = AlphaMode::Mask, .base_color = {1, 1, 1, 1}};
    material.base_color_texture = nearest(add(image));
    place(add(make_square()), add(material), at({0, 0, 0}));
    const RenderView view = look({0, 0, 1}, {0, 0, 0}, 8, 8);
    CHECK(rgb_at(radiance(view), 1, 1) == Vec3(0));
    CHECK(aov(view, "depth").at(1, 1, 0) == kNoDepth);
    CHECK(rgb_at(radiance(view), 6, 6) == kWhite);
    world.resource<Assets>().materials[0].alpha_cutoff = 0.3f;
    ++world.resource<Assets>().material_version;
    CHECK(rgb_at(radiance(view), 1, 1) == kRed);
}

// ---- velocity
// --------------------------------------------------------------------------------------

TEST_CASE_FIXTURE(
    Scene,
    "velocity: for a moving, rotating plate and a moving camera it is that of the projection") {
    const MeshId square = add(make_square());
    const Affine before = affine_from({-0.2f, 0.05f, 0.1f}, turn({0, 1, 1}, 10), {1, 1, 1});
    const Affine now = affine_from({0, 0, 0}, turn({0, 1, 1}, 14), {1, 1, 1});
    world.create(
        MeshInstance{square, add(Material{.double_sided = true})}, WorldTransform{now},
        PreviousWorldTransform{before});
    const Affine eye_before = look_at({0.1f, 0.02f, 1.6f}, {0, 0, 0});
    const Affine eye_now = look_at({0, 0, 1.5f}, {0.02f, 0, 0});
    for (const Vec2& jitter : {Vec2(0), Vec2(0.4f, -0.3f)}) {
        const RenderView view = make_render_view(
            {.fov_y = radians(70)}, eye_now, eye_before,
            {.width = 160, .height = 120, .jitter = jitter});
        const FrameOutput out = draw(view, {.aovs = {"depth", "velocity"}});
        REQUIRE(out.aovs.size() == 2);
        const gpu::FloatImage depth = gpu::read_floats(*out.aovs[0].texture);
        const gpu::FloatImage velocity = gpu::read_floats(*out.aovs[1].texture);
        const Mat4 world_from_clip = glm::inverse(view.clip_from_world);
        const Mat4 before_from_now = to_mat4(before) * glm::inverse(to_mat4(now));
        int checked = 0;
        for (int y = 0; y < 120; y += 5) {
            for (int x = 0; x < 160; x += 5) {
                const float distance = depth.at(x, y, 0);
                if (distance == kNoDepth) {
                    continue;
                }
                const Vec2 ndc = {
                    (static_cast<float>(x) + 0.5f) / 80 - 1,
                    1 - (static_cast<float>(y) + 0.5f) / 60};
                const Vec4 clip = Vec4(ndc * distance, view.near, distance);
                const Vec3 p = Vec3(world_from_clip * clip);
                const Vec3 q = Vec3(before_from_now * Vec4(p, 1));
                const Vec2 want = project(view, view.unjittered_from_world, p)
                                  - project(view, view.previous_clip_from_world, q);
                CHECK(glm::distance(want, velocity_at(velocity, x, y)) <= 0.05f);
                checked += glm::length(want) > 1 ? 1 : 0;
            }
        }
        CHECK(checked > 100);
    }
}

TEST_CASE_FIXTURE(Scene, "velocity: it is zero in the step of the spawn and for static instances") {
    const MeshId square = add(make_square());
    const MaterialId gray = add(Material{});
    const RenderView view = look({0, 0, 1}, {0, 0, 0}, 9, 9);
    place(square, gray, at({0, 0, 0}));
    CHECK(velocity_at(aov(view, "velocity"), 4, 4) == Vec2(0));
    world.clear();
    world.create(MeshInstance{square, gray}, WorldTransform{at({0, 0, 0})});  // no previous frame
    CHECK(velocity_at(aov(view, "velocity"), 4, 4) == Vec2(0));
}

TEST_CASE_FIXTURE(Scene, "velocity: between two steps it spans from frame to frame") {
    const MeshId square = add(make_square());
    world.create(
        MeshInstance{square, add(Material{})}, WorldTransform{at({0.4f, 0, 0})},
        PreviousWorldTransform{at({0, 0, 0})});
    const Affine eye = look_at({0, 0, 1}, {0, 0, 0});
    // 32 pixels show 1 m. From a quarter to three quarters of the step: 0.2 m.
    const RenderView view = make_render_view(
        {.fov_y = radians(90)}, eye, eye,
        {.width = 64, .height = 64, .alpha = 0.75f, .previous_alpha = 0.25f});
    CHECK(velocity_at(aov(view, "velocity"), 40, 32).x == test::near(0.2f * 32).epsilon(2e-3));
    // The plate stands at 0.3: from -0.7 on.
    const gpu::FloatImage depth = aov(view, "depth");
    CHECK(depth.at(8, 32, 0) == kNoDepth);
    CHECK(depth.at(10, 32, 0) == test::near(1));
}

}  // namespace limn::test::gbuffer_test
