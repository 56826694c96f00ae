#include "render/gpu/buffer_texture.h"
#include "render/gpu/device.h"
#include "render/gpu/shader_library.h"
#include "tests/render/render_fixture.h"
#include "tests/support.h"

#include <numeric>
#include <vector>

namespace limn::buffer_texture_test {
namespace {

/// The texel count that a shader sees, and the sum of the first components.
Vec2 read_texels(const BufferTexture& texture) {
    gpu::Device& device = test::shared_device();
    gpu::ShaderFiles files = gpu::ShaderFiles::standard();
    files.put(
        "sum.comp",
        "#version 450\nlayout(local_size_x = 1) in;\n"
        "layout(binding = 0) uniform samplerBuffer texels;\n"
        "layout(std430, binding = 0) writeonly buffer Sums { vec2 sums[]; };\n"
        "void main() {\n    int n = textureSize(texels);\n    vec2 sum = vec2(n, 0.0);\n"
        "    for (int i = 0; i < n; ++i) { sum.y += texelFetch(texels, i).r; }\n"
        "    sums[0] = sum;\n}\n");
    gpu::ShaderLibrary library(device.caps(), files);
    const Result<const gpu::Program*> program = library.load({.compute = "sum.comp"});
    REQUIRE_MESSAGE(program.ok(), (program ? "" : program.error().message));
    const gpu::Buffer target("sums", sizeof(Vec2), gpu::BufferUse::GpuOnly);
    device.use(**program);
    texture.bind(device, 0);
    device.bind_storage(0, target);
    device.dispatch(1);
    const Vec2 sums = target.read_value<Vec2>(0);
    device.invalidate_state();
    return sums;
}

TEST_CASE_FIXTURE(
    test::RenderTest, "buffer texture: an empty list reads as zeros, not as its neighbor") {
    const std::vector<Vec4> ones(64, Vec4(1));
    const gpu::Buffer neighbor = gpu::Buffer::of("ones", std::span<const Vec4>(ones));
    BufferTexture texture("list", GL_RGBA32F);
    texture.set(gpu::RingSlice{.buffer = neighbor.id()});
    const Vec2 read = read_texels(texture);
    CHECK(read.x == static_cast<float>(BufferTexture::kEmptyBytes / sizeof(Vec4)));
    CHECK(read.y == 0);
}

TEST_CASE_FIXTURE(
    test::RenderTest, "buffer texture: data beyond the device's limit is cut off and logged once") {
    std::vector<float> counted(100);
    std::iota(counted.begin(), counted.end(), 0.0f);
    const gpu::Buffer buffer = gpu::Buffer::of("counted", std::span<const float>(counted));
    BufferTexture texture("list", GL_R32F, 10);
    const std::vector<std::string> messages = test::messages_of([&] {
        texture.set(buffer);
        texture.set(buffer);
    });
    REQUIRE(messages.size() == 1);
    CHECK(messages[0].find("list: 400 bytes found, expected at most 40") == 0);
    CHECK(read_texels(texture) == Vec2(10, 45));
    CHECK(BufferTexture::max_texel_count() >= 65536);
}

}  // namespace
}  // namespace limn::buffer_texture_test
