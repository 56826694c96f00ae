#include "content/app/panels/hud_style.h"

#include <doctest/doctest.h>

#include <cmath>

namespace limn::hud_style_test {

TEST_CASE("hud_style: text scales with the window, and is never too small to read") {
    const auto text = [](float content_scale, int height) {
        return 14 * hud_scale(content_scale, height);
    };
    CHECK(text(1, 720) == 14);
    CHECK(text(1, 900) == 14);
    CHECK(text(1, 360) == 11);
    CHECK(text(1, 1) == 11);
    CHECK(text(1, 1080) == 17);
    CHECK(text(1, 2160) == 34);
    CHECK(text(2, 1440) == 28);  // a fine display
    CHECK(text(2, 720) == 22);
    CHECK(text(3, 2160) == 42);
    CHECK(text(1, 100000) == 35);
    float last = 0;
    for (int height = 100; height < 3000; height += 10) {
        CHECK(text(1, height) >= last);
        CHECK(std::abs(text(1, height) - std::round(text(1, height))) < 1e-4f);
        CHECK(text(2, height) >= text(1, height));
        last = text(1, height);
    }
}

}  // namespace limn::hud_style_test
