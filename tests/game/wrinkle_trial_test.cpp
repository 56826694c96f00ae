#include "content/game/wrinkle_trial_system.h"
#include "ecs/world.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace limn::wrinkle_trial_test {
namespace {

constexpr float kStep = 1.0f / 60;

/// A viewer before a face.
struct Viewing {
    World world;
    Entity face;

    explicit Viewing(std::uint64_t seed = 1) {
        world.insert_resource(FrameTime{.step = kStep});
        face = world.create(
            WrinkleTrial{.duration = 2, .pause = 0.5f, .seed = seed}, ClipPlayer{},
            WrinkleSurface{});
        world.run(add_wrinkle_trials);
    }
    void step() { world.run(update_wrinkle_trials); }
    void answer(TrialAnswer what) {
        world.get<WrinkleTrial>(face).answer = what;
        step();
    }
    [[nodiscard]] const WrinkleTrialState& state() { return world.get<WrinkleTrialState>(face); }
    [[nodiscard]] bool wrinkled() { return world.get<WrinkleSurface>(face).share > 0; }

    struct Clip {
        std::vector<float> times;  ///< of the clip player, step by step
        std::vector<bool> wrinkles;
    };
    /// Both clips from here to the question.
    std::vector<Clip> watch() {
        std::vector<Clip> clips;
        TrialStage last = TrialStage::Preference;
        for (int i = 0; i < 1000; ++i) {
            const TrialStage stage = state().stage;
            if (stage != TrialStage::FirstClip && stage != TrialStage::SecondClip) {
                break;
            }
            if (stage != last) {
                clips.emplace_back();
                last = stage;
            }
            step();
            clips.back().times.push_back(world.get<ClipPlayer>(face).time);
            clips.back().wrinkles.push_back(wrinkled());
        }
        return clips;
    }
};

bool all_are(const std::vector<bool>& values, bool value) {
    return std::ranges::all_of(values, [value](bool v) { return v == value; });
}

}  // namespace

TEST_CASE(
    "wrinkle trial: both clips show the same frames, one with and one without wrinkles"
    * technique("wrinkle.compression.ab-evaluation")) {
    for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
        Viewing viewing(seed);
        const std::vector<Viewing::Clip> clips = viewing.watch();
        REQUIRE(clips.size() == 2);
        CHECK(clips[0].times == clips[1].times);
        CHECK(clips[0].times.size() > 2.4f / kStep);
        CHECK(std::abs(clips[0].times.back() - 2) < 2 * kStep);
        const bool first = wrinkles_come_first(seed, 0);
        CHECK(all_are(clips[0].wrinkles, first));
        CHECK(all_are(clips[1].wrinkles, !first));
        CHECK(viewing.state().stage == TrialStage::AnyDifference);
    }
}

TEST_CASE("wrinkle trial: of every two viewers one sees wrinkles first, chosen by the seed") {
    int first = 0;
    for (std::size_t pair = 0; pair < 200; ++pair) {
        CHECK(wrinkles_come_first(7, 2 * pair) != wrinkles_come_first(7, 2 * pair + 1));
        first += wrinkles_come_first(7, 2 * pair) ? 1 : 0;
    }
    CHECK(first > 70);
    CHECK(first < 130);
}

TEST_CASE("wrinkle trial: a viewer who saw no difference is told and shown both again, then asked "
          "again") {
    Viewing viewing;
    viewing.watch();
    viewing.answer(TrialAnswer::First);  // not asked yet
    CHECK(viewing.state().stage == TrialStage::AnyDifference);
    viewing.answer(TrialAnswer::Same);
    CHECK(viewing.watch().size() == 2);
    CHECK(viewing.state().stage == TrialStage::Preference);
    viewing.answer(TrialAnswer::First);
    REQUIRE(viewing.state().records.size() == 1);
    const TrialRecord& one = viewing.state().records[0];
    CHECK(!one.noticed);
    CHECK(one.wrinkles_first == wrinkles_come_first(1, 0));
    CHECK(one.preferred_wrinkles == one.wrinkles_first);

    viewing.watch();
    viewing.answer(TrialAnswer::Different);
    CHECK(viewing.state().stage == TrialStage::Preference);
    viewing.answer(TrialAnswer::Second);
    REQUIRE(viewing.state().records.size() == 2);
    const TrialRecord& two = viewing.state().records[1];
    CHECK(two.noticed);
    CHECK(two.wrinkles_first != viewing.state().records[0].wrinkles_first);
    CHECK(two.preferred_wrinkles != two.wrinkles_first);
    viewing.answer(TrialAnswer::Different);  // while a clip plays: too early
    CHECK(viewing.state().stage == TrialStage::FirstClip);
}

TEST_CASE(
    "wrinkle trial: ten answers like those of the original study count as 2/3, 1/4 and 8/2"
    * technique("wrinkle.compression.ab-evaluation")) {
    std::vector<TrialRecord> records;
    for (int i = 0; i < 10; ++i) {
        records.push_back(
            {.wrinkles_first = i < 5,
             .noticed = i == 0 || i == 1 || i == 5,
             .preferred_wrinkles = i != 2 && i != 7});
    }
    const std::string text = describe_tally(tally_trials(records));
    for (const char* const pair :
         {"2/3, original study 2/3", "1/4, original study 1/4", "8/2, original study 8/2"}) {
        CHECK(text.find(pair) != std::string::npos);
    }
    const auto again = parse_trials(write_trials(records), "answers.csv");
    REQUIRE(again);
    CHECK(describe_tally(tally_trials(*again)) == text);
}

TEST_CASE("wrinkle trial: a bad file of answers is refused with its position") {
    const auto message = [](const char* text) {
        const auto parsed = parse_trials(text, "a.csv");
        return parsed ? std::string() : parsed.error().message;
    };
    CHECK(message("order\n").starts_with("a.csv:1: found \"order\", expected"));
    CHECK(message("order,noticed,preferred\nwrinkles first,none,smooth\nwrinkles,none,smooth\n")
              .starts_with("a.csv:3: found \"wrinkles,none,smooth\", expected"));
    CHECK(message("order,noticed,preferred\nwrinkles first,none\n").starts_with("a.csv:2: found"));
    CHECK(message("order,noticed,preferred\n").empty());
}

}  // namespace limn::wrinkle_trial_test
