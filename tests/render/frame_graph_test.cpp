#include "render/gpu/readback.h"
#include "render/gpu/shader_library.h"
#include "render/graph/frame_graph.h"
#include "tests/render/render_fixture.h"

#include <array>
#include <chrono>
#include <memory>

namespace limn::frame_graph_test {
namespace {

TextureSpec spec(std::string_view name, GLenum format = GL_RGBA8, int size = 8) {
    return {.name = name, .format = format, .width = size, .height = size};
}

void nothing(PassContext&) {}

TEST_CASE_FIXTURE(
    test::RenderTest, "frame graph: a target is cleared, bound and readable afterwards") {
    FrameGraph graph(device());
    graph.begin_frame();
    const TextureId color = graph.create(spec("color", GL_RGBA32F));
    const TextureId mask = graph.create(spec("mask", GL_R32UI));
    const TextureId depth = graph.create(spec("depth", GL_DEPTH32F_STENCIL8));
    graph.add_pass(
        "clear", {},
        {cleared(color, {1, 2, 3, 4}), cleared(mask, {9, 0, 0, 0}),
         cleared(depth, {0.25f, 1, 0, 0})},
        [](PassContext& context) { CHECK(context.size() == IVec2(8, 8)); });
    graph.keep(color);
    graph.keep(mask);
    graph.keep(depth);
    device().apply({.depth = {.write = false}, .color_mask = 0});  // masks must not stop a clear
    graph.execute();
    REQUIRE(graph.texture(color) != nullptr);
    CHECK(gpu::read_floats(*graph.texture(color)).at(7, 7, 2) == 3.0f);
    CHECK(gpu::read_floats(*graph.texture(mask)).at(0, 3, 0) == 9.0f);
    CHECK(gpu::read_floats(*graph.texture(depth)).at(0, 3, 0) == 0.25f);
}

TEST_CASE_FIXTURE(test::RenderTest, "frame graph: a pass that nothing needs is not run") {
    FrameGraph graph(device());
    graph.begin_frame();
    std::string ran;
    const TextureId a = graph.create(spec("a"));
    const TextureId b = graph.create(spec("b"));
    const TextureId unused = graph.create(spec("unused"));
    const TextureId out = graph.create(spec("out"));
    const auto log = [&](char c) { return [&ran, c](PassContext&) { ran += c; }; };
    graph.add_pass("a", {}, {a}, log('a'));
    graph.add_pass("b", {a}, {b}, log('b'));
    graph.add_pass("unused source", {a}, {unused}, log('u'));
    graph.add_pass("unused", {unused, b}, {unused}, log('v'));
    graph.add_pass("out", {b}, {out}, log('o'));
    graph.add_pass("always", {}, {}, log('!'));
    graph.always_run();
    graph.keep(out);
    // Reading what one draws to is refused; the chain above is otherwise as an effect might declare
    // it.
    REQUIRE(!graph.validate().ok());

    graph.begin_frame();
    const TextureId a2 = graph.create(spec("a"));
    const TextureId b2 = graph.create(spec("b"));
    const TextureId unused2 = graph.create(spec("unused"));
    const TextureId more2 = graph.create(spec("more"));
    const TextureId out2 = graph.create(spec("out"));
    graph.add_pass("a", {}, {a2}, log('a'));
    graph.add_pass("b", {a2}, {b2}, log('b'));
    graph.add_pass("unused source", {a2}, {unused2}, log('u'));
    graph.add_pass("unused", {unused2, b2}, {more2}, log('v'));
    graph.add_pass("out", {b2}, {out2}, log('o'));
    graph.add_pass("always", {}, {}, log('!'));
    graph.always_run();
    graph.keep(out2);
    graph.execute();
    CHECK(ran == "abo!");
    CHECK(graph.was_run("out"));
    CHECK(!graph.was_run("unused"));
    CHECK(graph.texture(unused2) == nullptr);
    CHECK(graph.stats().passes_run == 4);
    CHECK(graph.stats().passes_culled == 2);
}

TEST_CASE_FIXTURE(
    test::RenderTest,
    "frame graph: drawing over a target keeps the passes below, replacing it drops them") {
    FrameGraph graph(device());
    const auto run = [&](const auto& make_use) {
        std::string ran;
        graph.begin_frame();
        const TextureId color = graph.create(spec("color"));
        graph.add_pass("below", {}, {cleared(color)}, [&](PassContext&) { ran += 'b'; });
        graph.add_pass("above", {}, {make_use(color)}, [&](PassContext&) { ran += 'a'; });
        graph.keep(color);
        graph.execute();
        return ran;
    };
    CHECK(run([](TextureId t) { return Use(t); }) == "ba");
    CHECK(run([](TextureId t) { return discarded(t); }) == "a");
    CHECK(run([](TextureId t) { return cleared(t); }) == "a");
    CHECK(run([](TextureId t) { return image(t); }) == "ba");
    CHECK(
        run([](TextureId t) { return target_level(cleared(t), 0, 0); })
        == "ba");  // one layer is not all
}

TEST_CASE_FIXTURE(test::RenderTest, "frame graph: a pass that writes an imported texture runs") {
    FrameGraph graph(device());
    gpu::Texture outside("outside", {.format = GL_RGBA8, .width = 4, .height = 4});
    outside.clear({1, 1, 1, 1});
    graph.begin_frame();
    const TextureId id = graph.import("outside", outside);
    bool ran = false;
    graph.add_pass("write", {}, {cleared(id, {0, 1, 0, 1})}, [&](PassContext& context) {
        ran = true;
        CHECK(&context.texture(id) == &outside);
    });
    graph.execute();
    CHECK(ran);
    CHECK(graph.texture(id) == &outside);
    CHECK(gpu::read_bytes(outside).at(2, 2, 0) == 0);
    CHECK(gpu::read_bytes(outside).at(2, 2, 1) == 255);
}

TEST_CASE_FIXTURE(
    test::RenderTest, "frame graph: textures whose lifetimes do not overlap share memory") {
    FrameGraph graph(device());
    graph.begin_frame();
    // A chain a -> b -> c -> d needs two textures at a time.
    std::array<TextureId, 4> chain;
    std::array<GLuint, 4> names = {};
    for (std::size_t i = 0; i < chain.size(); ++i) {
        chain[i] = graph.create(spec(std::string("chain") + std::to_string(i)));
        const auto record = [&names, id = chain[i], i](PassContext& context) {
            names[i] = context.texture(id).id();
        };
        if (i == 0) {
            graph.add_pass("first", {}, {chain[i]}, record);
        } else {
            graph.add_pass("next" + std::to_string(i), {chain[i - 1]}, {chain[i]}, record);
        }
    }
    const TextureId other =
        graph.create(spec("other", GL_RGBA16F));  // another format shares no memory
    graph.add_pass("other", {}, {other}, nothing);
    graph.keep(chain[3]);
    graph.keep(other);
    graph.execute();
    CHECK(names[0] == names[2]);
    CHECK(names[1] == names[3]);
    CHECK(names[0] != names[1]);
    CHECK(graph.stats().pool_textures == 3);
    CHECK(graph.stats().unshared_bytes == 4 * 64 * 4 + 64 * 8);
    CHECK(graph.stats().pool_bytes == 2 * 64 * 4 + 64 * 8);
    // Memory that went to a later texture is not shown as the earlier one.
    CHECK(graph.texture(chain[1]) == nullptr);
    CHECK(graph.texture(chain[3]) != nullptr);
}

TEST_CASE_FIXTURE(
    test::RenderTest, "frame graph: a kept texture shares no memory, also when kept by name") {
    FrameGraph graph(device());
    const auto frame = [&] {
        graph.begin_frame();
        const TextureId a = graph.create(spec("gbuffer.normal"));
        const TextureId b = graph.create(spec("b"));
        const TextureId c = graph.create(spec("c"));
        graph.add_pass("a", {}, {cleared(a, {1, 0, 0, 1})}, nothing);
        graph.add_pass("b", {a}, {cleared(b, {0, 1, 0, 1})}, nothing);
        graph.add_pass("c", {b}, {cleared(c, {0, 0, 1, 1})}, nothing);
        graph.keep(c);
        graph.execute();
        const TextureId found = graph.find("gbuffer.normal");
        REQUIRE(found == a);
        const gpu::Texture* texture = graph.texture(found);
        return texture != nullptr ? gpu::read_bytes(*texture).at(0, 0, 0) : -1;
    };
    CHECK(frame() == -1);  // gone to c
    graph.keep_named("gbuffer.normal");
    CHECK(frame() == 255);
    graph.forget_named("gbuffer.normal");
    CHECK(frame() == -1);
    CHECK(!graph.find("no such texture").valid());
    CHECK(graph.texture_names() == std::vector<std::string_view>{"gbuffer.normal", "b", "c"});
}

TEST_CASE_FIXTURE(test::RenderTest, "frame graph: passes that write a texture kept by name run") {
    FrameGraph graph(device());
    graph.keep_named("debug");
    graph.begin_frame();
    const TextureId debug = graph.create(spec("debug"));
    graph.add_pass("debug", {}, {cleared(debug)}, nothing);
    graph.execute();
    CHECK(graph.was_run("debug"));
}

TEST_CASE_FIXTURE(
    test::RenderTest, "frame graph: after the first frame nothing is created, after a resize old "
                      "textures are freed") {
    FrameGraph graph(device());
    const auto frame = [&](int size) {
        graph.begin_frame();
        const TextureId a = graph.create(spec("a", GL_RGBA8, size));
        const TextureId b = graph.create(spec("b", GL_RGBA8, size));
        graph.add_pass("a", {}, {a}, nothing);
        graph.add_pass("b", {a}, {b}, nothing);
        graph.keep(b);
        graph.execute();
        return graph.texture(b)->serial();
    };
    const auto textures = gpu::live_objects(gpu::ObjectKind::Texture);
    const std::uint64_t first = frame(16);
    const auto framebuffers = gpu::live_objects(gpu::ObjectKind::Framebuffer);
    for (int i = 0; i < 20; ++i) {
        CHECK(frame(16) == first);
    }
    CHECK(gpu::live_objects(gpu::ObjectKind::Texture) == textures + 2);
    CHECK(gpu::live_objects(gpu::ObjectKind::Framebuffer) == framebuffers);
    for (int i = 0; i < 20; ++i) {
        static_cast<void>(frame(32));
    }
    CHECK(gpu::live_objects(gpu::ObjectKind::Texture) == textures + 2);
    CHECK(gpu::live_objects(gpu::ObjectKind::Framebuffer) == framebuffers);
}

TEST_CASE_FIXTURE(test::RenderTest, "frame graph: a wrong declaration is named") {
    FrameGraph graph(device());
    const auto message = [&] {
        const Status status = graph.validate();
        return status.ok() ? std::string() : status.error().message;
    };
    graph.begin_frame();
    const TextureId a = graph.create(spec("a"));
    const TextureId b = graph.create(spec("b"));
    graph.add_pass("early", {a}, {b}, nothing);
    graph.add_pass("late", {}, {a}, nothing);
    CHECK(
        message()
        == "frame graph: pass early: read of a before any write found, expected an earlier pass "
           "that writes it");

    graph.begin_frame();
    const TextureId c = graph.create(spec("c"));
    graph.add_pass("make", {}, {cleared(c)}, nothing);
    graph.add_pass("feedback", {c}, {c}, nothing);
    CHECK(
        message()
        == "frame graph: pass feedback: c found both read and drawn to, expected one of them");

    graph.begin_frame();
    const TextureId small = graph.create(spec("small", GL_RGBA8, 4));
    const TextureId large = graph.create(spec("large", GL_RGBA8, 8));
    graph.add_pass("mixed", {}, {small, large}, nothing);
    CHECK(
        message()
        == "frame graph: pass mixed: target large of 8x8 found, expected 4x4 like its other "
           "targets");

    // Not mistakes: an image read and written, the depth buffer tested and sampled, a mip chain.
    graph.begin_frame();
    const TextureId d = graph.create(spec("depth", GL_DEPTH_COMPONENT32F));
    const TextureId e = graph.create({.name = "chain", .width = 8, .height = 8, .levels = 3});
    graph.add_pass("depth", {}, {cleared(d), cleared(e)}, nothing);
    graph.add_pass("test", {depth_tested(d), d}, {e}, nothing);
    graph.add_pass("down", {e}, {target_level(e, 1)}, nothing);
    graph.add_pass("image", {e}, {image(e)}, nothing);
    graph.keep(e);
    CHECK(message().empty());
    graph.execute();
}

TEST_CASE_FIXTURE(
    test::RenderTest,
    "frame graph: shader writes are followed by one barrier before they are read") {
    FrameGraph graph(device());
    graph.begin_frame();
    const TextureId picture = graph.create(spec("picture", GL_R32F));
    const BufferId counts = graph.create_buffer({.name = "counts", .bytes = 64});
    const TextureId out = graph.create(spec("out"));
    graph.add_pass("store", {}, {image(picture), counts}, nothing);
    graph.add_pass("plain", {}, {cleared(out)}, nothing);
    graph.add_pass("use", {picture, counts}, {out}, nothing);
    graph.add_pass("use again", {picture, counts}, {out}, nothing);
    graph.keep(out);
    graph.execute();
    CHECK(graph.stats().barriers == 1);

    graph.begin_frame();
    const TextureId last = graph.create(spec("last", GL_R32F));
    graph.add_pass("store", {}, {image(last)}, nothing);
    graph.keep(last);
    graph.execute();
    CHECK(graph.stats().barriers == 1);  // for whoever reads it after the frame
}

TEST_CASE_FIXTURE(test::RenderTest, "frame graph: the next pass reads what compute shaders write") {
    gpu::ShaderFiles files;
    files.put("write.comp", R"(#version 450
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, r32f) uniform writeonly image2D image;
layout(std430, binding = 1) writeonly buffer Sums { float sums[]; };
void main() {
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    imageStore(image, p, vec4(float(p.x + 8 * p.y)));
    sums[p.x + 8 * p.y] = 1000.0;
})");
    files.put("full.vert", R"(#version 450
void main() { gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.5, 1.0); })");
    files.put("read.frag", R"(#version 450
layout(binding = 0) uniform sampler2D image;
layout(std430, binding = 1) readonly buffer Sums { float sums[]; };
layout(location = 0) out float value;
void main() { ivec2 p = ivec2(gl_FragCoord.xy); value = texelFetch(image, p, 0).r + sums[p.x + 8 * p.y]; })");
    gpu::ShaderLibrary library(device().caps(), std::move(files));
    const auto write = library.load({.compute = "write.comp"});
    const auto read = library.load({.vertex = "full.vert", .fragment = "read.frag"});
    REQUIRE(write.ok());
    REQUIRE(read.ok());
    FrameGraph graph(device());
    graph.begin_frame();
    const TextureId picture = graph.create(spec("picture", GL_R32F));
    const BufferId sums = graph.create_buffer({.name = "sums", .bytes = 256});
    const TextureId out = graph.create(spec("out", GL_R32F));
    graph.add_pass("write", {}, {image(picture), sums}, [&](PassContext& context) {
        context.device().use(**write);
        context.bind_image(0, picture, GL_WRITE_ONLY);
        context.bind_storage(1, sums);
        context.device().dispatch_over(8, 8, 8);
    });
    graph.add_pass("read", {picture, sums}, {discarded(out)}, [&](PassContext& context) {
        context.device().use(gpu::Pipeline{*read, gpu::kFullscreenState});
        context.bind_texture(0, picture);
        context.bind_storage(1, sums);
        context.device().draw_fullscreen();
    });
    graph.keep(out);
    graph.execute();
    CHECK(
        gpu::read_floats(*graph.texture(out)).at(5, 7, 0)
        == 1005.0f);  // the top row is y = 0 in OpenGL's last
    CHECK(gpu::read_floats(*graph.texture(out)).at(5, 0, 0) == 1061.0f);
}

TEST_CASE_FIXTURE(test::RenderTest, "frame graph: one layer of a cube is drawn alone") {
    FrameGraph graph(device());
    graph.begin_frame();
    const TextureId cube = graph.create(
        {.name = "cube",
         .format = GL_RGBA8,
         .width = 4,
         .height = 4,
         .target = GL_TEXTURE_CUBE_MAP});
    graph.add_pass("all", {}, {cleared(cube)}, nothing);
    graph.add_pass("face", {}, {target_level(cleared(cube, {1, 1, 1, 1}), 0, 2)}, nothing);
    graph.keep(cube);
    graph.execute();
    const gpu::Texture& texture = *graph.texture(cube);
    CHECK(gpu::read_bytes(texture, 0, 2).at(1, 1, 0) == 255);
    CHECK(gpu::read_bytes(texture, 0, 1).at(1, 1, 0) == 0);
    CHECK(gpu::read_bytes(texture, 0, 5).at(1, 1, 0) == 0);
}

TEST_CASE_FIXTURE(
    test::RenderTest, "frame graph: every pass is timed on CPU and GPU, equal names together") {
    FrameGraph graph(device());
    double last_frame_ms = 0;
    for (int i = 0; i < 20; ++i) {
        const auto begin = std::chrono::steady_clock::now();
        graph.begin_frame();
        const TextureId a = graph.create(spec("a", GL_RGBA32F, 512));
        graph.add_pass("clear", {}, {cleared(a, Vec4(1))}, nothing);
        graph.add_pass("blur", {}, {a}, nothing);
        graph.add_pass("blur", {}, {a}, nothing);
        graph.keep(a);
        graph.execute();
        glFinish();
        const std::chrono::duration<double, std::milli> time =
            std::chrono::steady_clock::now() - begin;
        last_frame_ms = time.count();
    }
    graph.wait_for_timings();
    REQUIRE(graph.timings().size() == 2);
    CHECK(graph.timings()[0].name == "clear");
    CHECK(graph.timings()[1].name == "blur");
    CHECK(graph.timings()[0].cpu_ms > 0);
    CHECK(graph.timings()[0].gpu_ms >= 0);
    CHECK(graph.total_cpu_ms() >= graph.timings()[1].cpu_ms * 0.5);
    CHECK(graph.total_gpu_ms() > 0);
    // The passes of the last frame take no longer than the frame.
    CHECK(graph.timings()[0].last_gpu_ms + graph.timings()[1].last_gpu_ms <= last_frame_ms);
    CHECK(graph.timings()[0].last_cpu_ms + graph.timings()[1].last_cpu_ms <= last_frame_ms);
}

TEST_CASE_FIXTURE(test::RenderTest, "frame graph: names of the last frame outlive new ones") {
    FrameGraph graph(device());
    graph.begin_frame();
    const TextureId a = graph.create(spec("a"));
    graph.add_pass("first", {}, {a}, nothing);
    graph.keep(a);
    graph.execute();
    const std::vector<std::string_view> textures = graph.texture_names();
    graph.begin_frame();
    for (int i = 0; i < 100; ++i) {
        const TextureId other = graph.create(spec("other" + std::to_string(i)));
        graph.add_pass("pass" + std::to_string(i), {}, {other}, nothing);
    }
    CHECK(graph.timings()[0].name == "first");
    CHECK(textures == std::vector<std::string_view>{"a"});
}

TEST_CASE_FIXTURE(test::RenderTest, "frame graph: captures of passes are destroyed, run or not") {
    const auto token = std::make_shared<int>(1);
    {
        FrameGraph graph(device());
        graph.begin_frame();
        const TextureId a = graph.create(spec("a"));
        graph.add_pass("kept", {}, {a}, [token](PassContext&) {});
        const TextureId b = graph.create(spec("b"));
        graph.add_pass("dropped", {}, {b}, [token](PassContext&) {});
        graph.keep(a);
        CHECK(token.use_count() == 3);
        graph.execute();
        graph.begin_frame();
        CHECK(token.use_count() == 1);
        // Large captures need more than one block of memory.
        struct Large {
            std::shared_ptr<int> token;
            std::array<char, 30'000> bytes = {};
        };
        const TextureId c = graph.create(spec("c"));
        for (int i = 0; i < 7; ++i) {
            graph.add_pass("large", {}, {c}, [large = Large{token}](PassContext&) {
                CHECK(*large.token == 1);
            });
        }
        graph.keep(c);
        graph.execute();
        CHECK(token.use_count() == 8);
    }
    CHECK(token.use_count() == 1);
}

TEST_CASE_FIXTURE(test::RenderTest, "frame graph: prints itself as a table and as DOT") {
    FrameGraph graph(device());
    graph.begin_frame();
    const TextureId depth = graph.create(spec("depth", GL_DEPTH_COMPONENT32F));
    const TextureId hdr = graph.create(spec("hdr", GL_RGBA16F));
    const TextureId lost = graph.create(spec("lost"));
    graph.add_pass("opaque", {}, {cleared(depth), cleared(hdr)}, nothing);
    graph.add_pass("lost \"pass\"", {depth}, {lost}, nothing);
    graph.keep(hdr);
    graph.execute();
    const std::string text = graph.to_text();
    CHECK(text.find("opaque") != std::string::npos);
    CHECK(text.find("- -> depth hdr") != std::string::npos);
    CHECK(text.find("not run") != std::string::npos);
    CHECK(text.find("texture hdr: RGBA16F 8x8, texture slot") != std::string::npos);
    CHECK(text.find("texture lost: RGBA8 8x8, unused") != std::string::npos);
    const std::string dot = graph.to_dot();
    CHECK(dot.find("digraph frame {") == 0);
    CHECK(dot.find("p0 -> r0;") != std::string::npos);
    CHECK(dot.find("r0 -> p1;") != std::string::npos);
    CHECK(dot.find("label=\"lost \\\"pass\\\"\", style=dashed") != std::string::npos);
    CHECK(dot.back() == '\n');
}

}  // namespace
}  // namespace limn::frame_graph_test
