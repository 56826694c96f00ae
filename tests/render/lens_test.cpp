#include "ecs/components/glare.h"
#include "ecs/components/glow.h"
#include "ecs/components/motion_blur.h"
#include "ecs/components/ripple.h"
#include "render/graph/frame_graph.h"
#include "tests/render/scene_fixture.h"

#include <string_view>

namespace limn::test {
namespace {

/// Where the first pass whose name begins so is in the last frame; -1 if there is none.
int place_of(std::string_view begin) {
    const auto timings = frame_graph(shared_renderer()).timings();
    for (std::size_t i = 0; i < timings.size(); ++i) {
        if (timings[i].name.starts_with(begin)) {
            return static_cast<int>(i);
        }
    }
    return -1;
}

}  // namespace

TEST_CASE_FIXTURE(Scene, "lens: what nobody asks for has neither a pass nor a target") {
    place(add(make_square()), add(Material{}), at({0, 0, 0}));
    static_cast<void>(draw(look({0, 0, 1}, {0, 0, 0}, 32, 24)));
    CHECK(place_of("glow") == -1);
    CHECK(place_of("motion") == -1);
    CHECK(!frame_graph(shared_renderer()).find("radiance with glow").valid());
}

TEST_CASE_FIXTURE(Scene, "lens: the shutter comes before the glow, and both before the tone map") {
    place(add(make_square()), add(Material{}), at({0, 0, 0}));
    world.insert_resource(Glow{});
    world.insert_resource(Glare{});
    world.insert_resource(MotionBlur{});
    world.create(ScreenRipple{.age = 0.1f});
    static_cast<void>(draw(look({0, 0, 1}, {0, 0, 0}, 32, 24)));
    CHECK(place_of("ripple") > place_of("lights"));
    CHECK(place_of("motion") > place_of("ripple"));
    CHECK(place_of("glare") > place_of("motion"));
    CHECK(place_of("glow") > place_of("glare"));
    CHECK(place_of("tone map") > place_of("glow"));
}

}  // namespace limn::test
