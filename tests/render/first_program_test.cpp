#include "render/geometry/mesh_pool.h"
#include "render/gpu/buffer.h"
#include "render/gpu/shader_library.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/support.h"
#include "tests/technique.h"

#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <set>

// What the renderer takes for granted of the pipeline - interpolation, the tests at its end, what
// flows from stage to stage - from the first pair of programs on (shade.pipeline-model,
// shade.passthrough-cube, shade.parameters).

namespace limn::test::first_program_test {
namespace {

using DVec3 = glm::dvec3;
using gpu::Buffer;

/// Position in clip space and whatever else flows through.
struct Vertex {
    Vec4 clip;
    Vec3 value = {0, 0, 0};
};

const std::string kPassVertex = R"(#version 450
layout(location = 0) in vec4 clip;
layout(location = 1) in vec3 value;
layout(location = 0) out vec3 passed;
void main() { gl_Position = clip; passed = value; })";
const std::string kPassFragment = R"(#version 450
layout(location = 0) in vec3 passed;
layout(location = 0) out vec4 color;
void main() { color = vec4(passed, 1.0); })";

/// A target of color, depth and stencil, and a pair of shaders that pass through what they get.
class PairTest : public RenderTest {
  public:
    explicit PairTest(int side = 65, GLenum format = GL_RGBA32F)
        : color("color", {.format = format, .width = side, .height = side}),
          depth("depth", {.format = GL_DEPTH32F_STENCIL8, .width = side, .height = side}) {
        const gpu::Attachment attachment = {&color};
        framebuffer = gpu::Framebuffer("pair", std::span(&attachment, 1), {&depth});
        color.clear({0, 0, 0, 0});
        depth.clear({0, 0, 0, 0});
    }

    void draw(
        const std::vector<Vertex>& vertices, const gpu::PipelineState& state = {},
        const std::string& fragment = kPassFragment) {
        const gpu::VertexAttribute attributes[] = {
            {.location = 0, .components = 4},
            {.location = 1, .components = 3, .offset = offsetof(Vertex, value)}};
        gpu::VertexArray array("pair", attributes);
        const Buffer buffer = Buffer::of("pair", std::span<const Vertex>(vertices));
        array.set_vertices(0, buffer, 0, sizeof(Vertex));
        gpu::ShaderFiles files;
        files.put("pass.vert", kPassVertex);
        files.put("pass.frag", fragment);
        gpu::ShaderLibrary library(device().caps(), files);
        const auto program = library.load({.vertex = "pass.vert", .fragment = "pass.frag"});
        REQUIRE_MESSAGE(program.ok(), (program ? "" : program.error().message));
        device().bind_framebuffer(framebuffer);
        device().bind_vertex_array(array);
        device().use(gpu::Pipeline{*program, state});
        device().draw(GL_TRIANGLES, 0, static_cast<int>(vertices.size()));
        device().invalidate_state();
    }

    gpu::Texture color;
    gpu::Texture depth;
    gpu::Framebuffer framebuffer;
};

/// The whole image, left and right at their own w.
std::vector<Vertex>
full_quad(float w_left, float w_right, const Vec3& left, const Vec3& right, float z = 0.5f) {
    const auto at = [&](float x, float y) {
        const float w = x < 0 ? w_left : w_right;
        return Vertex{Vec4(x, y, z, 1) * w, x < 0 ? left : right};
    };
    return {at(-1, -1), at(1, -1), at(1, 1), at(-1, -1), at(1, 1), at(-1, 1)};
}

// The cube of the book: vertex numbers of its six faces. They are clockwise from outside.
constexpr int kCubeFaceVertices[6][4] = {{0, 1, 2, 3}, {3, 2, 6, 7}, {7, 6, 5, 4},
                                         {4, 5, 1, 0}, {5, 6, 2, 1}, {7, 4, 0, 3}};
Vec3 cube_vertex(int i) {
    return {
        i < 4 ? -1.0f : 1.0f, i == 0 || i == 1 || i == 4 || i == 5 ? -1.0f : 1.0f,
        i == 0 || i == 3 || i == 4 || i == 7 ? 1.0f : -1.0f};
}

/// Counter-clockwise, three vertex numbers a triangle.
std::vector<std::uint32_t> cube_indices() {
    std::vector<std::uint32_t> indices;
    for (const auto& face : kCubeFaceVertices) {
        for (const int corner : {0, 2, 1, 0, 3, 2}) {
            indices.push_back(static_cast<std::uint32_t>(face[corner]));
        }
    }
    return indices;
}

/// Where the ray first meets the cube of half side 1, if it does.
std::optional<DVec3> meet_cube(const DVec3& origin, const DVec3& direction) {
    double enter = 0;
    double leave = INFINITY;
    for (int i = 0; i < 3; ++i) {
        const double a = (-1 - origin[i]) / direction[i];
        const double b = (1 - origin[i]) / direction[i];
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
    }
    return enter < leave ? std::optional(origin + enter * direction) : std::nullopt;
}

/// Largest difference, in codes of 8 bits, of the image from the position that each pixel shows.
template <typename Code>
double worst_code(const RenderView& view, Code&& code) {
    const glm::dmat4 world_from_clip = glm::inverse(glm::dmat4(view.clip_from_world));
    const auto& r = view.world_from_camera.row;
    const DVec3 eye = {r[0].w, r[1].w, r[2].w};
    double worst = 0;
    int covered = 0;
    for (int y = 0; y < view.height; ++y) {
        for (int x = 0; x < view.width; ++x) {
            const glm::dvec4 beyond =
                world_from_clip
                * glm::dvec4(
                    (x + 0.5) / view.width * 2 - 1, 1 - (y + 0.5) / view.height * 2, 0.5, 1);
            const std::optional<DVec3> p = meet_cube(eye, DVec3(beyond) / beyond.w - eye);
            for (int c = 0; c < 3 && p; ++c) {
                const double want = std::clamp((*p)[c], 0.0, 1.0) * 255;
                worst = std::max(worst, std::abs(code(x, y, c) - want));
            }
            covered += p ? 1 : 0;
        }
    }
    REQUIRE(covered > 1500);
    return worst;
}

RenderView cube_view(const Vec3& eye) {
    const Affine pose = look_at(eye, {0, 0, 0});
    return make_render_view(
        {.fov_y = radians(40.0f), .near = 1}, pose, pose, {.width = 128, .height = 128});
}

}  // namespace

// ---- shade.pipeline-model --------------------------------------------------------------------

TEST_CASE_FIXTURE(
    PairTest, "pipeline: interpolation is linear in space, not on the screen"
                  * technique("shade.pipeline-model")) {
    draw(full_quad(1, 3, Vec3(0), Vec3(1)));
    const gpu::FloatImage image = gpu::read_floats(color);
    CHECK(image.at(32, 32, 0) == test::near(0.25).epsilon(1e-5));
    for (int x = 0; x < 65; ++x) {
        const double s = (x + 0.5) / 65;
        CHECK(image.at(x, 10, 0) == test::near(s / 3 / ((1 - s) + s / 3)).epsilon(1e-5));
    }
}

TEST_CASE_FIXTURE(
    PairTest,
    "pipeline: a fragment that fails a test changes no bit" * technique("shade.pipeline-model")) {
    draw(full_quad(1, 1, {0.1f, 0.2f, 0.3f}, {0.9f, 0.7f, 0.5f}));
    const gpu::FloatImage colors = gpu::read_floats(color);
    const gpu::FloatImage depths = gpu::read_floats(depth);
    const auto unchanged = [&] {
        return gpu::read_floats(color).pixels == colors.pixels
               && gpu::read_floats(depth).pixels == depths.pixels;
    };
    const auto nearer = full_quad(1, 1, Vec3(4), Vec3(4), 0.75f);
    const auto farther = full_quad(1, 1, Vec3(4), Vec3(4), 0.25f);
    draw(farther);
    CHECK(unchanged());
    draw(nearer, {.stencil = {.test = true, .front = {.func = GL_NEVER}}});
    CHECK(unchanged());
    device().set_scissor(0, 0, 0, 0);
    draw(nearer);
    device().disable_scissor();
    CHECK(unchanged());
    // Those that pass change what they cover, and no more.
    device().bind_framebuffer(framebuffer);
    device().set_scissor(0, 0, 65, 20);
    draw(nearer);
    device().disable_scissor();
    const gpu::FloatImage image = gpu::read_floats(color);
    CHECK(image.at(3, 64, 0) == 4);
    CHECK(image.at(3, 44, 0) == colors.at(3, 44, 0));
    CHECK(gpu::read_floats(depth).at(3, 64, 0) == 0.75f);
}

TEST_CASE_FIXTURE(
    Scene, "pipeline: a mesh without tangents is drawn without its normal map, and logged once"
               * technique("shade.pipeline-model")) {
    MeshData mesh = make_square();
    mesh.name = "sheet";
    mesh.tangents.clear();
    ImageData lean = {.name = "lean", .width = 1, .height = 1, .pixels = {218, 128, 218, 255}};
    const MaterialId plain = add(Material{});
    Material material;
    material.normal_texture.image = add(std::move(lean));
    const MaterialId bumped = add(material);
    const MeshId sheet = add(std::move(mesh));
    const MeshId whole = add(make_square());
    const RenderView view = look({0, 0, 1}, {0, 0, 0}, 9, 9);
    const auto normal_of = [&](MeshId id, MaterialId with) {
        world.clear();
        place(id, with, at({0, 0, 0}));
        return rgb_at(aov(view, "normal"), 4, 4);
    };
    CHECK(normal_of(whole, bumped).x > 0.5f);
    const std::vector<std::string> messages = messages_of([&] {
        CHECK(glm::distance(normal_of(sheet, plain), Vec3(0, 0, 1)) < 1e-3f);
        CHECK(glm::distance(normal_of(sheet, bumped), Vec3(0, 0, 1)) < 1e-3f);
        CHECK(glm::distance(normal_of(sheet, bumped), Vec3(0, 0, 1)) < 1e-3f);
    });
    REQUIRE(messages.size() == 1);
    CHECK(messages[0].find("mesh sheet: no tangents found") == 0);
}

// ---- shade.passthrough-cube ------------------------------------------------------------------

TEST_CASE(
    "first_program: the cube's triangles look outward" * technique("shade.passthrough-cube")) {
    const std::vector<std::uint32_t> indices = cube_indices();
    REQUIRE(indices.size() == 36);
    for (std::size_t i = 0; i < indices.size(); i += 3) {
        const Vec3 a = cube_vertex(static_cast<int>(indices[i]));
        const Vec3 b = cube_vertex(static_cast<int>(indices[i + 1]));
        const Vec3 c = cube_vertex(static_cast<int>(indices[i + 2]));
        CHECK(glm::dot(glm::cross(b - a, c - a), a + b + c) > 0);
    }
}

TEST_CASE(
    "first_program: every pixel of the color cube is the position it shows"
    * technique("shade.passthrough-cube")) {
    for (const Vec3& eye : {Vec3(0, 0, 5), Vec3(2.6f, 2.9f, 3.2f), Vec3(-3, -2, 3.4f)}) {
        const RenderView view = cube_view(eye);
        std::vector<Vertex> vertices;
        for (const std::uint32_t i : cube_indices()) {
            const Vec3 p = cube_vertex(static_cast<int>(i));
            vertices.push_back({view.clip_from_world * Vec4(p, 1), p});
        }
        PairTest pair(128, GL_RGBA8);
        pair.draw(vertices);
        const gpu::ByteImage picture = gpu::read_bytes(pair.color);
        CHECK(worst_code(view, [&](int x, int y, int c) { return picture.at(x, y, c); }) <= 1);
    }
}

TEST_CASE_FIXTURE(
    Scene, "first_program: the renderer's own programs draw the same cube"
               * technique("shade.passthrough-cube")) {
    MeshData cube;
    cube.name = "color cube";
    for (int i = 0; i < 8; ++i) {
        cube.positions.push_back(cube_vertex(i));
        cube.normals.push_back(glm::normalize(cube_vertex(i)));
        cube.colors.emplace_back(cube_vertex(i), 1);  // below 0, too
    }
    cube.indices = cube_indices();
    cube.bounds = {{-1, -1, -1}, {1, 1, 1}};
    const MeshId mesh = add(std::move(cube));
    for (const AlphaMode mode : {AlphaMode::Opaque, AlphaMode::Blend}) {
        world.clear();
        const Material material = {
            .shading = ShadingModel::Unlit, .alpha_mode = mode, .base_color = {1, 1, 1, 1}};
        place(mesh, add(material), at({0, 0, 0}));
        const RenderView view = cube_view({2.6f, 2.9f, 3.2f});
        const gpu::FloatImage picture = radiance(view);
        const auto code = [&](int x, int y, int c) { return 255.0 * picture.at(x, y, c); };
        CHECK(worst_code(view, code) <= 1);
    }
}

// ---- shade.parameters ------------------------------------------------------------------------

TEST_CASE_FIXTURE(
    RenderTest, "parameters: programs of meshes read exactly the attributes that meshes have"
                    * technique("shade.parameters")) {
    std::set<int> read;
    for (const char* fragment : {"gbuffer.frag", "shadow_map.frag"}) {
        for (const std::vector<gpu::ShaderDefine>& defines :
             {std::vector<gpu::ShaderDefine>{},
              {{"NORMAL_MAP"}, {"BASE_COLOR_MAP"}, {"UV_MAP"}, {"VERTEX_COLOR"}, {"VELOCITY"}},
              {{"WRINKLE_MAP"}, {"WRINKLE_DISPLACED"}},
              {{"VELOCITY"}, {"DEFORMED"}},
              {{"INFLATE"}, {"ALPHA_MASK"}}}) {
            const auto program = device().shaders().load(
                {.vertex = "mesh.vert", .fragment = fragment, .defines = defines});
            REQUIRE(program.ok());
            const Status fits = (*program)->expect_inputs(mesh_attributes());
            CHECK_MESSAGE(fits.ok(), (fits ? "" : fits.error().message));
            for (const gpu::ProgramInput& input : (*program)->inputs()) {
                read.insert(input.location);
            }
        }
    }
    std::set<int> had;
    for (const gpu::VertexAttribute& attribute : mesh_attributes()) {
        had.insert(static_cast<int>(attribute.location));
    }
    CHECK(read == had);
}

TEST_CASE_FIXTURE(
    RenderTest, "parameters: varyings that do not match between stages are a context error"
                    * technique("shade.parameters")) {
    gpu::ShaderFiles files;
    files.put("pass.vert", kPassVertex);
    files.put("pass.frag", kPassFragment);
    files.put("more.frag", R"(#version 450
layout(location = 0) in vec3 passed;
layout(location = 1) in vec3 never_written;
layout(location = 0) out vec4 color;
void main() { color = vec4(passed + never_written, 1.0); })");
    gpu::ShaderLibrary library(device().caps(), files);
    const auto broken = library.load({.vertex = "pass.vert", .fragment = "more.frag"});
    REQUIRE_FALSE(broken.ok());
    CHECK(broken.error().message.find("pass.vert + more.frag: context: ") == 0);

    const auto whole = library.load({.vertex = "pass.vert", .fragment = "pass.frag"});
    REQUIRE(whole.ok());
    REQUIRE((*whole)->inputs().size() == 2);
    CHECK((*whole)->inputs()[1].name == "value");
    CHECK((*whole)->inputs()[1].type == GL_FLOAT_VEC3);
    const gpu::VertexAttribute one[] = {{.location = 0, .components = 4}};
    const Status missing = (*whole)->expect_inputs(one);
    REQUIRE_FALSE(missing.ok());
    CHECK(
        missing.error().message.find("context: attribute value at location 1")
        != std::string::npos);
    const gpu::VertexAttribute whole_numbers[] = {
        {.location = 0, .components = 4}, {.location = 1, .type = GL_INT, .integer = true}};
    CHECK_FALSE((*whole)->expect_inputs(whole_numbers).ok());
}

TEST_CASE_FIXTURE(
    PairTest, "parameters: an interpolated normal is short, the renderer's is not"
                  * technique("shade.parameters")) {
    for (const auto& [degrees, length] : {std::pair(60.0f, 0.8660), std::pair(90.0f, 0.7071)}) {
        const float half = radians(0.5f * degrees);
        const Vec3 left = {-std::sin(half), 0, std::cos(half)};
        const Vec3 right = {std::sin(half), 0, std::cos(half)};
        depth.clear({0, 0, 0, 0});
        draw(full_quad(1, 1, left, right));
        const gpu::FloatImage image = gpu::read_floats(color);
        CHECK(glm::length(rgb_at(image, 32, 32)) == test::near(length).epsilon(1e-4));

        Scene scene;
        MeshData mesh = make_square();
        mesh.normals = {left, right, right, left};
        scene.place(scene.add(std::move(mesh)), scene.add(Material{}), at({0, 0, 0}));
        const gpu::FloatImage normals = scene.aov(scene.look({0, 0, 1}, {0, 0, 0}), "normal");
        CHECK(glm::length(rgb_at(normals, 32, 32)) == test::near(1).epsilon(1e-4));
        CHECK(rgb_at(normals, 32, 32).z > 0.99f);
    }
}

}  // namespace limn::test::first_program_test
