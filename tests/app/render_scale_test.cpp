#include "content/app/player/render_scale.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <initializer_list>

namespace limn::render_scale_test {

TEST_CASE("render_scale: a CPU draws a 16:9 window at 640 x 360, a GPU at full resolution") {
    const IVec2 window = {1280, 720};
    CHECK(render_size(make_render_scale(0, false, true, window), window) == IVec2(640, 360));
    CHECK(render_size(make_render_scale(0, false, false, window), window) == window);
    const IVec2 full = {1920, 1080};
    CHECK(render_size(make_render_scale(0, false, true, full), full) == IVec2(640, 360));
    const IVec2 small = {320, 180};
    CHECK(render_size(make_render_scale(0, false, true, small), small) == small);
}

TEST_CASE("render_scale: a CPU adapts to 16 frames per second, unless a scale is requested") {
    RenderScale scale = make_render_scale(0, false, true, {1280, 720});
    CHECK(scale.automatic);
    float frame = 0.0f;
    for (int i = 0; i < 400; ++i) {
        frame = 20.0f + 800.0f * scale.scale * scale.scale;  // a level that is slow at 640 x 360
        update_render_scale(scale, frame, frame, frame * 1e-3f);
    }
    CHECK(frame <= 1.1f * 60.0f);
    CHECK(frame >= 0.6f * 60.0f);
    CHECK_FALSE(make_render_scale(0.5f, false, true, {1280, 720}).automatic);
    CHECK_FALSE(make_render_scale(0, false, false, {1280, 720}).automatic);
}

TEST_CASE("render_scale: a requested scale is used as is") {
    const IVec2 window = {1280, 720};
    CHECK(render_size(make_render_scale(0.5f, false, false, window), window) == IVec2(640, 360));
    CHECK(render_size(make_render_scale(1.0f, false, true, window), window) == window);
    CHECK(render_size(make_render_scale(0.1f, false, false, {20, 20}), {20, 20}) == IVec2(16, 16));
}

TEST_CASE("render_scale: auto converges to the target frame time, from above and from below") {
    for (const float start : {0.2f, 1.0f}) {
        RenderScale scale = make_render_scale(start, true, false, {1280, 720});
        float busy = 0.0f;
        int late_changes = 0;
        for (int i = 0; i < 4000; ++i) {
            busy = 40.0f * scale.scale * scale.scale;  // a machine that needs 40 ms for all pixels
            const float frame = std::max(busy, 16.67f);  // the display waits
            const bool changed = update_render_scale(scale, frame, busy, frame * 1e-3f);
            late_changes += changed && i > 2000 ? 1 : 0;
        }
        CAPTURE(start);
        CHECK(busy <= 1.10f * 16.67f);
        CHECK(busy >= 0.6f * 16.67f);
        CHECK(late_changes == 0);  // it does not swing
    }
}

TEST_CASE(
    "render_scale: particles are thinned only at the lowest resolution, until the target is met") {
    RenderScale scale = make_render_scale(0, false, true, {1280, 720});
    scale.thins_particles = true;
    float frame = 0;
    for (int i = 0; i < 400; ++i) {
        frame = 5.0f + 40.0f * scale.scale * scale.scale + 1000.0f * scale.particle_share;
        const float share = scale.particle_share;
        const float before = scale.scale;
        update_render_scale(scale, frame, frame, frame * 1e-3f);
        CHECK((scale.particle_share == share || before == kMinScale));
        CHECK(scale.particle_share <= share);
    }
    CHECK(frame <= 1.1f * 60.0f);
    CHECK(scale.particle_share < 0.1f);
    CHECK(scale.particle_share > 0.01f);

    RenderScale still = make_render_scale(0, false, true, {1280, 720});
    for (int i = 0; i < 100; ++i) {
        update_render_scale(still, 1000, 1000, 1);  // without such particles
    }
    CHECK(still.particle_share == 1);
}

TEST_CASE("render_scale: without auto nothing changes") {
    RenderScale scale = make_render_scale(0.5f, false, false, {1280, 720});
    CHECK_FALSE(update_render_scale(scale, 200.0f, 200.0f, 10.0f));
    CHECK(scale.scale == 0.5f);
}

}  // namespace limn::render_scale_test
