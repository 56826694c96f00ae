// The level relax (wrinkle.compression.ab-evaluation): its two clips differ in nothing but
// wrinkles.

#include "content/app/commands/headless.h"
#include "content/app/commands/stage.h"
#include "content/app/player/posed_mesh.h"
#include "content/game/wrinkle_trial.h"
#include "ecs/components/surface.h"
#include "ecs/components/transform.h"
#include "render/gpu/readback.h"
#include "render/render_view.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <vector>

namespace limn::relax_test {
namespace {

constexpr IVec2 kSize = {160, 90};

struct Rectangle {
    float left = 1e9f, right = -1e9f, top = 1e9f, bottom = -1e9f;  ///< pixels

    void add(const Vec2& pixel) {
        left = std::min(left, pixel.x);
        right = std::max(right, pixel.x);
        top = std::min(top, pixel.y);
        bottom = std::max(bottom, pixel.y);
    }
    [[nodiscard]] bool has(int x, int y, float margin) const {
        const auto px = static_cast<float>(x);
        const auto py = static_cast<float>(y);
        return px >= left - margin && px <= right + margin && py >= top - margin
               && py <= bottom + margin;
    }
};

/// The level, with what a viewer sees of it.
class Viewer {
  public:
    Viewer() {
        Result<std::unique_ptr<Stage>> opened = open_stage("relax");
        REQUIRE_MESSAGE(opened.ok(), (opened ? std::string() : opened.error().message));
        stage = *std::move(opened);
        Result<HeadlessRenderer> made = create_headless_renderer();
        REQUIRE(made.ok());
        headless = *std::move(made);
        stage->world.query<const WrinkleTrial>().each(
            [&](Entity entity, const WrinkleTrial&) { face = entity; });
        step_stage(*stage);
    }
    /// Until a clip has played for `time` [s].
    void wait_for(TrialStage what, float time) {
        for (int i = 0; i < 2000; ++i) {
            const auto& state = stage->world.get<WrinkleTrialState>(face);
            const float pause = stage->world.get<WrinkleTrial>(face).pause;
            if (state.stage == what && state.time > pause + time) {
                return;
            }
            step_stage(*stage);
        }
        FAIL("the clip never comes");
    }
    [[nodiscard]] RenderView view() const {
        return make_render_view(
            stage->world, stage->scene.camera, {.width = kSize.x, .height = kSize.y});
    }
    gpu::ByteImage draw() {
        return gpu::read_bytes(*render_frame(*headless.renderer, stage->world, view()).display);
    }
    std::vector<Vec3> positions() { return posed_positions(stage->world, face); }
    /// Of the skin that may wrinkle.
    Rectangle forehead() {
        Rectangle area;
        const auto& assets = stage->world.resource<Assets>();
        const MeshData& mesh = assets.meshes[stage->world.get<MeshInstance>(face).mesh.index];
        const auto region = std::ranges::find(mesh.regions, "forehead", &VertexRegion::name);
        REQUIRE(region != mesh.regions.end());
        const std::vector<Vec3> moved = positions();
        const Affine& world = stage->world.get<WorldTransform>(face).world;
        const Mat4 clip_from_world = view().clip_from_world;
        for (std::size_t v = 0; v < moved.size(); ++v) {
            if (region->weights[v] > 0) {
                const Vec4 clip = clip_from_world * Vec4(transform_point(world, moved[v]), 1);
                area.add(
                    {(0.5f + 0.5f * clip.x / clip.w) * static_cast<float>(kSize.x),
                     (0.5f - 0.5f * clip.y / clip.w) * static_cast<float>(kSize.y)});
            }
        }
        return area;
    }

    std::unique_ptr<Stage> stage;
    HeadlessRenderer headless;
    Entity face;
};

bool differ(const gpu::ByteImage& a, const gpu::ByteImage& b, int x, int y) {
    const std::ptrdiff_t at = (y * kSize.x + x) * a.channels;
    return !std::equal(a.pixels.begin() + at, a.pixels.begin() + at + 3, b.pixels.begin() + at);
}

}  // namespace

TEST_CASE(
    "relax: both clips move the same skin, and differ only on the forehead"
    * technique("wrinkle.compression.ab-evaluation")) {
    Viewer viewer;
    struct Seen {
        std::vector<Vec3> positions;
        gpu::ByteImage image;
    };
    std::vector<Seen> views;
    Rectangle forehead;
    for (const TrialStage stage : {TrialStage::FirstClip, TrialStage::SecondClip}) {
        for (const float time : {0.1f, 1.3f}) {  // at rest, and with raised brows
            viewer.wait_for(stage, time);
            views.push_back({viewer.positions(), viewer.draw()});
            forehead = viewer.forehead();
        }
    }
    REQUIRE(!views[0].positions.empty());
    CHECK(views[0].positions == views[2].positions);
    CHECK(views[1].positions == views[3].positions);
    CHECK(views[0].positions != views[1].positions);
    int on_forehead = 0;
    int elsewhere = 0;
    int at_rest = 0;
    for (int y = 0; y < kSize.y; ++y) {
        for (int x = 0; x < kSize.x; ++x) {
            at_rest += differ(views[0].image, views[2].image, x, y) ? 1 : 0;
            if (differ(views[1].image, views[3].image, x, y)) {
                ++(forehead.has(x, y, 2) ? on_forehead : elsewhere);
            }
        }
    }
    CHECK(at_rest == 0);
    CHECK(on_forehead > 20);
    CHECK(elsewhere == 0);
}

}  // namespace limn::relax_test
