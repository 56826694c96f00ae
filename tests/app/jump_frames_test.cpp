#include "tests/app/read_image.h"
#include "tests/app/run_program.h"

#include <doctest/doctest.h>

#include <cstdlib>
#include <string>
#include <vector>

namespace limn::jump_frames_test {

using test::Picture;
using test::read_image;
using test::run_limn;
using test::TemporaryFolder;

namespace {

constexpr int kJumpWidth = 96;
constexpr int kJumpHeight = 64;

/// A white square of 0.5 m whose clip moves it from x = -1 to 1 within a second.
const std::string kSlider =
    R"json({
    "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
    "nodes": [{"name": "mover", "mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
    "extensionsUsed": ["KHR_materials_unlit"],
    "materials": [{"extensions": {"KHR_materials_unlit": {}}, "doubleSided": true}],
    "bufferViews": [
        {"buffer": 0, "byteOffset": 0, "byteLength": 48},
        {"buffer": 0, "byteOffset": 48, "byteLength": 12},
        {"buffer": 0, "byteOffset": 60, "byteLength": 8},
        {"buffer": 0, "byteOffset": 68, "byteLength": 24}],
    "accessors": [
        {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3",
         "min": [-0.25, -0.25, 0], "max": [0.25, 0.25, 0]},
        {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"},
        {"bufferView": 2, "componentType": 5126, "count": 2, "type": "SCALAR",
         "min": [0], "max": [1]},
        {"bufferView": 3, "componentType": 5126, "count": 2, "type": "VEC3"}],
    "animations": [{"samplers": [{"input": 2, "output": 3}],
        "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]}],
    "buffers": [{"byteLength": 92, "uri": "data:application/octet-stream;base64,)json"
    "AACAvgAAgL4AAAAAAACAPgAAgL4AAAAAAACAPgAAgD4AAAAAAACAvgAAgD4AAAAAAAABAAIAAAACAAMAAAAA"
    "AAAAgD8AAIC/AAAAAAAAAAAAAIA/AAAAAAAAAAA="
    R"json("}]})json";

/// In the upper half the clip, in the lower half a square that an event moves from x = -1 to 1. The
/// image is 2 m high at z = 0: 32 px a meter.
const std::string kJumpLevel = R"json({
    "resources": {"environment": {"sky": "uniform", "zenith": [0, 0, 0]},
                  "motion_blur": {"shutter": 360}},
    "meshes": {"square": {"make": "box", "size": [0.5, 0.5, 0.001]}},
    "materials": {"white": {"shading": "unlit", "base_color": [1, 1, 1, 1]}},
    "entities": [
        {"name": "clip", "gltf": "slider.gltf", "transform": {"position": [0, 0.5, 0]}},
        {"name": "square", "transform": {"position": [-1, -0.5, 0]},
         "mesh_instance": {"mesh": "square", "material": "white"}},
        {"name": "view", "transform": {"position": [0, 0, 2]}, "camera": {"fov_y": 0.9272952}}],
    "events": [{"at": 1, "set": {"square": {"transform": {"position": [1, -0.5, 0]}}}}]
})json";

/// Light in half of the image, in white pixels: beyond half a meter from the center, and within.
struct JumpLight {
    double left = 0;
    double middle = 0;
    double right = 0;
};

JumpLight jump_light(const Picture& image, int first_row) {
    JumpLight light;
    const auto red = static_cast<std::size_t>(image.channel("R"));
    for (int y = first_row; y < first_row + kJumpHeight / 2; ++y) {
        for (int x = 0; x < kJumpWidth; ++x) {
            const auto at = static_cast<std::size_t>(y * kJumpWidth + x) * image.channels.size();
            const int offset = 2 * x + 1 - kJumpWidth;  // [half px]
            double& part = std::abs(offset) < 32 ? light.middle
                           : offset < 0          ? light.left
                                                 : light.right;
            part += static_cast<double>(image.values[at + red]);
        }
    }
    return light;
}

void render_jumps(const TemporaryFolder& folder, std::vector<std::string> words) {
    test::write_text(folder.file("slider.gltf"), kSlider);
    test::write_text(folder.file("a.level.json"), kJumpLevel);
    words.insert(words.begin(), {"render", "a.level.json", "--size", "96x64"});
    const auto run = run_limn(folder, words);
    CAPTURE(run.err);
    REQUIRE(run.exit_code == 0);
}

Picture read_jump(const TemporaryFolder& folder, const std::string& name) {
    Picture image = read_image(folder.file(name));
    REQUIRE(image.whole);
    return image;
}

}  // namespace

TEST_CASE("step jumps: no frame interpolates across a loop's end or an event's set, however it is "
          "blurred") {
    // A square has 16 x 16 px. At 120 frames a second every other one lies between two steps.
    constexpr double kSquare = 256;
    const TemporaryFolder folder;
    render_jumps(folder, {"-o", "a%04d.exr", "--frames", "119:122", "--fps", "120"});
    for (int frame = 119; frame <= 122; ++frame) {
        CAPTURE(frame);
        const Picture image = read_jump(folder, "a0" + std::to_string(frame) + ".exr");
        for (const int first_row : {0, kJumpHeight / 2}) {
            const JumpLight light = jump_light(image, first_row);
            CHECK(light.middle == 0);
            CHECK(std::abs(light.left + light.right - kSquare) < 0.1 * kSquare);
            // The clip is at its end before 1 s and at its beginning after, the event the reverse.
            if (frame != 120) {
                const bool is_left = (frame > 120) == (first_row == 0);
                CHECK((is_left ? light.right : light.left) == 0);
            }
        }
    }
}

TEST_CASE("step jumps: the truth of many samples shows a loop's end and its beginning, and nothing "
          "between") {
    const TemporaryFolder folder;
    render_jumps(folder, {"-o", "a.exr", "--time", "1", "--spp", "8"});
    const Picture image = read_jump(folder, "a.exr");
    for (const int first_row : {0, kJumpHeight / 2}) {
        const JumpLight light = jump_light(image, first_row);
        CHECK(light.middle == 0);
        CHECK(light.left > 100);
        CHECK(light.right > 100);
    }
}

}  // namespace limn::jump_frames_test
