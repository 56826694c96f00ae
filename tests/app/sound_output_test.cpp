#include "content/app/player/sound_output.h"
#include "tests/near.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <vector>

namespace limn::sound_output_test {

using test::near;

TEST_CASE("sound output: the scene follows the sound, which jumps only where they are far apart") {
    CHECK(*sound_correction(3, 3.004) == 0);
    CHECK(*sound_correction(3, 3.05) == near(0.005));
    CHECK(*sound_correction(3.05, 3) == near(-0.005));
    CHECK_FALSE(sound_correction(3, 3.1));
    CHECK_FALSE(sound_correction(3, 0));
    // Clocks that differ by 1 % stay together, at 60 frames a second.
    double scene = 0;
    double largest = 0;
    for (int frame = 0; frame < 6000; ++frame) {
        const double sound = frame / 60.0;
        const std::optional<double> correction = sound_correction(scene, sound);
        REQUIRE(correction);
        largest = std::max(largest, std::abs(scene - sound));
        scene += 0.99 / 60 + *correction;
    }
    CHECK(largest < 0.01);
}

TEST_CASE("sound output: a device without loudspeakers plays what is to be heard") {
    setenv("ALSOFT_DRIVERS", "null", 1);
    SoundOutput output;
    CHECK(output.update(0, true) == 0);
    CHECK_FALSE(output.is_heard());
    output.set_sounds({{SoundData{8000, 1, std::vector<float>(80000, 0.1f)}, 1, 0, 1}});
    (void)output.update(0.5, true);
    CHECK_FALSE(output.is_heard());
    (void)output.update(1.5, true);
    CHECK(output.is_heard());
    (void)output.update(1.5, false);  // paused
    CHECK_FALSE(output.is_heard());
    (void)output.update(12, true);
    CHECK_FALSE(output.is_heard());
    output.set_sounds({});
    (void)output.update(1.5, true);
    CHECK_FALSE(output.is_heard());
    unsetenv("ALSOFT_DRIVERS");
}

}  // namespace limn::sound_output_test
