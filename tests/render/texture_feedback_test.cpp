#include "ecs/components/texture_feedback.h"
#include "ecs/components/time.h"
#include "tests/near.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace limn::test::texture_feedback_test {
namespace {

constexpr int kSide = 16;
using Cells = std::vector<std::uint8_t>;  // kSide x kSide, row by row from the top

ImageData image_of(const Cells& cells) {
    ImageData image{
        .name = "cells",
        .width = kSide,
        .height = kSide,
        .format = PixelFormat::Rgba32F,
        .pixels = {}};
    for (const std::uint8_t cell : cells) {
        const std::array<float, 4> texel = {static_cast<float>(cell), 0, 0, 1};
        const auto* bytes = reinterpret_cast<const std::uint8_t*>(texel.data());
        image.pixels.insert(image.pixels.end(), bytes, bytes + sizeof texel);
    }
    return image;
}

/// Life by its definition, on a torus.
Cells next(const Cells& cells) {
    Cells grown(cells.size());
    for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
            int neighbors = 0;
            for (int j = -1; j <= 1; ++j) {
                for (int i = -1; i <= 1; ++i) {
                    const int at = (y + j + kSide) % kSide * kSide + (x + i + kSide) % kSide;
                    neighbors += i == 0 && j == 0 ? 0 : cells[static_cast<std::size_t>(at)];
                }
            }
            const auto here = static_cast<std::size_t>(y * kSide + x);
            grown[here] = neighbors == 3 || (neighbors == 2 && cells[here] != 0) ? 1 : 0;
        }
    }
    return grown;
}

Cells glider(int x, int y) {
    Cells cells(kSide * kSide);
    for (const IVec2 p : {IVec2(1, 0), IVec2(2, 1), IVec2(0, 2), IVec2(1, 2), IVec2(2, 2)}) {
        cells[static_cast<std::size_t>((y + p.y) % kSide * kSide + (x + p.x) % kSide)] = 1;
    }
    return cells;
}

/// A square that fills the image with the state, one texel per pixel.
struct FeedbackScene : Scene {
    Entity painter;

    void make(const Cells& start, TextureFeedback feedback) {
        feedback.start = add(image_of(start));
        feedback.target = add(image_of(Cells(kSide * kSide)));
        feedback.low = Vec3(0);
        feedback.high = Vec3(1);
        Material material = {.shading = ShadingModel::Unlit, .base_color = {1, 1, 1, 1}};
        material.base_color_texture.image = feedback.target;
        material.base_color_texture.nearest = true;
        place(add(make_square()), add(material), at({0, 0, 0}));
        painter = world.create(feedback);
    }
    gpu::FloatImage at_time(double time) {
        world.insert_resource(FrameTime{.step = 1.0f / 60, .time = time});
        return radiance(look({0, 0, 1}, {0, 0, 0}, kSide, kSide));
    }
    Cells cells_at(double time) {
        const gpu::FloatImage image = at_time(time);
        Cells cells;
        for (int y = 0; y < kSide; ++y) {
            for (int x = 0; x < kSide; ++x) {
                cells.push_back(image.at(x, y, 0) > 0.5f ? 1 : 0);
            }
        }
        return cells;
    }
};

}  // namespace

TEST_CASE_FIXTURE(
    FeedbackScene,
    "texture feedback: n additions of 1 to zeros are n" * technique("tex.feedback")) {
    make(Cells(kSide * kSide), {.rule = FeedbackRule::Add, .rate = 10, .amount = 1});
    for (const int steps : {0, 1, 2, 7, 8, 100}) {
        const gpu::FloatImage image = at_time(0.1 * steps);
        CHECK(image.at(3, 5, 0) == near(static_cast<double>(steps)).epsilon(1e-3));
        CHECK(image.at(3, 5, 1) == near(static_cast<double>(steps)).epsilon(1e-3));
    }
}

TEST_CASE_FIXTURE(
    FeedbackScene, "texture feedback: a glider of Life moves by (1, 1) in four steps"
                       * technique("tex.feedback")) {
    make(glider(2, 3), {.rule = FeedbackRule::Life, .rate = 1});
    CHECK(cells_at(0) == glider(2, 3));
    CHECK(cells_at(4) == glider(3, 4));
    CHECK(cells_at(8) == glider(4, 5));
    CHECK(cells_at(64) == glider(2, 3));  // around the edges
}

TEST_CASE_FIXTURE(
    FeedbackScene,
    "texture feedback: any cells live and die as on the CPU" * technique("tex.feedback")) {
    Cells cells;
    std::uint32_t bits = 12345;
    for (int i = 0; i < kSide * kSide; ++i) {
        bits = bits * 1664525u + 1013904223u;
        cells.push_back(bits >> 30 == 0 ? 1 : 0);
    }
    make(cells, {.rule = FeedbackRule::Life, .rate = 5});
    for (int step = 0; step <= 12; ++step) {
        CHECK(cells_at(0.2 * step + 0.01) == cells);
        cells = next(cells);
    }
}

TEST_CASE_FIXTURE(
    FeedbackScene, "texture feedback: the state depends on time, not on the frames drawn before"
                       * technique("tex.feedback")) {
    make(glider(2, 3), {.rule = FeedbackRule::Life, .rate = 20});
    const gpu::FloatImage at_once = at_time(3);
    (void)at_time(0.4);  // back, which starts anew
    for (double time = 0.5; time < 3; time += 0.27) {
        (void)at_time(time);
    }
    CHECK(largest_difference(at_time(3), at_once) == 0);
    CHECK(largest_difference(at_time(3.2), at_once) > 0);
}

TEST_CASE_FIXTURE(
    FeedbackScene, "texture feedback: a target that is its own start, or none, changes nothing") {
    make(glider(2, 3), {.rule = FeedbackRule::Life, .rate = 1});
    auto& feedback = world.get<TextureFeedback>(painter);
    feedback.start = feedback.target;
    CHECK(cells_at(4) == Cells(kSide * kSide));
    feedback.start = {};
    CHECK(cells_at(4) == Cells(kSide * kSide));
}

}  // namespace limn::test::texture_feedback_test
