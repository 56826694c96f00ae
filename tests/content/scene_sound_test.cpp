#include "content/sound/scene_sound.h"
#include "ecs/components/sound_player.h"
#include "ecs/world.h"
#include "tests/near.h"
#include "tests/support.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <cmath>
#include <fstream>

namespace limn::scene_sound_test {
namespace {

using test::near;

/// A tone of 440 Hz.
SoundData tone(int rate, double seconds, int channels = 1) {
    SoundData sound{rate, channels, {}};
    const int frames = static_cast<int>(rate * seconds);
    for (int i = 0; i < frames; ++i) {
        for (int c = 0; c < channels; ++c) {
            sound.samples.push_back(
                0.5f * static_cast<float>(std::sin(2 * 3.14159265358979 * 440 * i / rate + c)));
        }
    }
    return sound;
}

}  // namespace

TEST_CASE("scene sound: a file that was written comes back, to the precision of 16 bits") {
    const test::TemporaryFolder folder;
    for (const int channels : {1, 2}) {
        const SoundData sound = tone(22050, 0.3, channels);
        REQUIRE(save_wave(sound, folder.file("tone.wav")).ok());
        const Result<SoundData> back = load_sound(folder.file("tone.wav"));
        REQUIRE(back.ok());
        CHECK(back->rate == 22050);
        CHECK(back->channels == channels);
        CHECK(back->duration() == near(0.3));
        REQUIRE(back->samples.size() == sound.samples.size());
        for (std::size_t i = 0; i < sound.samples.size(); ++i) {
            REQUIRE(std::abs(back->samples[i] - sound.samples[i]) < 1.0f / 32000);
        }
    }
    SoundData loud = tone(8000, 0.1);
    loud.samples[5] = 7;  // clipped, not wrapped
    REQUIRE(save_wave(loud, folder.file("loud.wav")).ok());
    CHECK(load_sound(folder.file("loud.wav"))->samples[5] > 0.999f);
}

TEST_CASE("scene sound: what is no sound is one line; the others are still heard") {
    const test::TemporaryFolder folder;
    std::ofstream(folder.file("text.wav")) << "no sound at all";
    std::ofstream(folder.file("empty.wav"));
    REQUIRE(save_wave(tone(8000, 0.1), folder.file("good.wav")).ok());
    World world;
    for (const char* name : {"missing.wav", "text.wav", "empty.wav", "good.wav", ""}) {
        SoundPlayer sound;
        sound.file = name;
        world.create(sound);
    }
    std::vector<std::string> problems;
    const std::vector<SceneSound> sounds = find_sounds(world, folder.path(), problems);
    CHECK(sounds.size() == 1);
    REQUIRE(problems.size() == 4);
    CHECK(problems[0].find("missing.wav: found no such file") != std::string::npos);
    for (const std::string& problem : problems) {
        CHECK(problem.find("expected a sound") != std::string::npos);
        CHECK(problem.find('\n') == std::string::npos);
    }
    CHECK_FALSE(save_wave(tone(8000, 0.1), folder.file("no/such/folder.wav")).ok());
}

TEST_CASE(
    "scene sound: it begins at its time, once or again and again"
    * technique("face.talking-head")) {
    SceneSound sound{tone(8000, 0.5), 2, 0, 1};
    CHECK_FALSE(sound_position(sound, 1.99));
    CHECK(*sound_position(sound, 2.3) == near(0.3));
    CHECK_FALSE(sound_position(sound, 2.5));
    CHECK_FALSE(sound_position(sound, 5));
    sound.every = 3;
    CHECK_FALSE(sound_position(sound, 1));
    CHECK_FALSE(sound_position(sound, 4.9));
    CHECK(*sound_position(sound, 5.1) == near(0.1));
    CHECK(*sound_position(sound, 2 + 3 * 1000 + 0.25) == near(0.25));
    sound.every = 0.2;  // before it ends
    CHECK(*sound_position(sound, 2.25) == near(0.05));
}

TEST_CASE("scene sound: a mix is the sum of its sounds, at their times and gains") {
    const SceneSound low{tone(8000, 1), 0.5, 0, 0.5f};
    const SceneSound high{tone(16000, 1, 2), 1, 0, 1};
    const SceneSound both[] = {low, high};
    const SoundData mix = mix_sounds(both, 0.25, 2.25);
    CHECK(mix.rate == 16000);
    CHECK(mix.channels == 2);
    CHECK(mix.duration() == near(2));
    const auto at = [&](double time, int channel) {
        return mix.samples
            [2 * static_cast<std::size_t>(std::llround((time - 0.25) * 16000))
             + static_cast<std::size_t>(channel)];
    };
    CHECK(at(0.4, 0) == 0);
    CHECK(at(2.2, 1) == 0);
    for (const double time : {0.6, 0.75, 1.2, 1.45, 1.8}) {
        const auto wave = [&](double start, double gain, double phase) {
            return time < start || time > start + 1
                       ? 0
                       : gain * 0.5 * std::sin(2 * 3.14159265358979 * 440 * (time - start) + phase);
        };
        CHECK(at(time, 0) == near(wave(0.5, 0.5, 0) + wave(1, 1, 0)).epsilon(0.002).scale(1));
        CHECK(at(time, 1) == near(wave(0.5, 0.5, 0) + wave(1, 1, 1)).epsilon(0.002).scale(1));
    }
    CHECK(mix_sounds({}, 0, 1).samples.size() == 96000);
    CHECK(mix_sounds(both, 2, 1).samples.empty());
}

}  // namespace limn::scene_sound_test
