#include "content/game/wrinkle_trial_system.h"

#include "ecs/base/rng.h"
#include "ecs/base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

// Techniques: wrinkle.compression.ab-evaluation

namespace limn {

namespace {

constexpr std::string_view kHeader = "order,noticed,preferred";
constexpr std::string_view kFirst = "wrinkles first";
constexpr std::string_view kLast = "wrinkles last";
constexpr std::string_view kYes = "a difference";
constexpr std::string_view kNo = "none";
constexpr std::string_view kWrinkles = "wrinkles";
constexpr std::string_view kSmooth = "smooth";

void enter(WrinkleTrialState& state, TrialStage stage) {
    state.stage = stage;
    state.time = 0;
}

void take_answer(WrinkleTrial& trial, WrinkleTrialState& state) {
    const TrialAnswer answer = std::exchange(trial.answer, TrialAnswer::None);
    const bool compares = answer == TrialAnswer::Same || answer == TrialAnswer::Different;
    const bool prefers = answer == TrialAnswer::First || answer == TrialAnswer::Second;
    if (state.stage == TrialStage::AnyDifference && compares) {
        state.noticed = answer == TrialAnswer::Different;
        state.told = !state.noticed;
        enter(state, state.noticed ? TrialStage::Preference : TrialStage::FirstClip);
    } else if (state.stage == TrialStage::Preference && prefers) {
        const bool first = wrinkles_come_first(trial.seed, state.records.size());
        state.records.push_back(
            {.wrinkles_first = first,
             .noticed = state.noticed,
             .preferred_wrinkles = (answer == TrialAnswer::First) == first});
        state.told = false;
        enter(state, TrialStage::FirstClip);
    }
}

TrialStage after_clip(const WrinkleTrialState& state) {
    if (state.stage == TrialStage::FirstClip) {
        return TrialStage::SecondClip;
    }
    return state.told ? TrialStage::Preference : TrialStage::AnyDifference;
}

/// One of two words; null: neither.
const bool* read_word(std::string_view word, std::string_view yes, std::string_view no) {
    static constexpr bool kTruth[] = {false, true};
    return word == yes ? &kTruth[1] : word == no ? &kTruth[0] : nullptr;
}

Result<TrialRecord> parse_record(std::string_view line, const std::string& location) {
    std::vector<std::string_view> words;
    for (std::size_t at = 0; at <= line.size();) {
        const std::size_t comma = std::min(line.find(',', at), line.size());
        words.push_back(line.substr(at, comma - at));
        at = comma + 1;
    }
    if (words.size() == 3) {
        const bool* const first = read_word(words[0], kFirst, kLast);
        const bool* const noticed = read_word(words[1], kYes, kNo);
        const bool* const preferred = read_word(words[2], kWrinkles, kSmooth);
        if (first != nullptr && noticed != nullptr && preferred != nullptr) {
            return TrialRecord{*first, *noticed, *preferred};
        }
    }
    return fail(
        "{}: found \"{}\", expected as \"{},{},{}\"", location, line.substr(0, 60), kFirst, kYes,
        kWrinkles);
}

}  // namespace

void add_wrinkle_trials(
    Query<const WrinkleTrial, Without<WrinkleTrialState>> trials, Commands commands) {
    trials.each(
        [&](Entity entity, const WrinkleTrial&) { commands.add(entity, WrinkleTrialState{}); });
}

void update_wrinkle_trials(
    Query<WrinkleTrial, WrinkleTrialState, ClipPlayer, WrinkleSurface> trials,
    Res<const FrameTime> time) {
    trials.each([&](WrinkleTrial& trial, WrinkleTrialState& state, ClipPlayer& player,
                    WrinkleSurface& surface) {
        if (state.stage == TrialStage::FirstClip || state.stage == TrialStage::SecondClip) {
            trial.answer = TrialAnswer::None;  // too early
            const bool first = wrinkles_come_first(trial.seed, state.records.size());
            const bool wrinkles = (state.stage == TrialStage::FirstClip) == first;
            state.share = state.share < 0 ? surface.share : state.share;
            surface.share = wrinkles ? state.share : 0;
            // Set from the stage's time, so that both playbacks show the same frames.
            player.time = std::max(state.time - trial.pause, 0.0f);
            player.speed = 0;
            state.time += time->step;
            if (state.time > trial.pause + trial.duration) {
                enter(state, after_clip(state));
            }
            return;
        }
        player.time = 0;
        take_answer(trial, state);
    });
}

bool wrinkles_come_first(std::uint64_t seed, std::size_t viewer) {
    Random random(seed, viewer / 2, name_hash("wrinkle_trial"), 0);
    return (random.word() % 2 == 1) == (viewer % 2 == 0);
}

TrialTally tally_trials(std::span<const TrialRecord> records) {
    TrialTally tally;
    const auto count = [](TrialTally::Count& of, bool yes) { ++(yes ? of.yes : of.no); };
    for (const TrialRecord& record : records) {
        count(
            record.wrinkles_first ? tally.noticed_wrinkles_first : tally.noticed_wrinkles_last,
            record.noticed);
        count(tally.preferred_wrinkles, record.preferred_wrinkles);
    }
    return tally;
}

TrialTally source_tally() {
    return {
        .noticed_wrinkles_first = {2, 3},
        .noticed_wrinkles_last = {1, 4},
        .preferred_wrinkles = {8, 2}};
}

std::string describe_tally(const TrialTally& tally) {
    const TrialTally source = source_tally();
    const auto line = [](const char* what, const TrialTally::Count& found,
                         const TrialTally::Count& theirs) {
        return fmt::format(
            "{:<52} {}/{}, original study {}/{}\n", what, found.yes, found.no, theirs.yes,
            theirs.no);
    };
    return line(
               "saw a difference, wrinkles first (yes/no)", tally.noticed_wrinkles_first,
               source.noticed_wrinkles_first)
           + line(
               "saw a difference, wrinkles last (yes/no)", tally.noticed_wrinkles_last,
               source.noticed_wrinkles_last)
           + line(
               "preferred the face with/without wrinkles", tally.preferred_wrinkles,
               source.preferred_wrinkles);
}

std::string write_trials(std::span<const TrialRecord> records) {
    std::string text = fmt::format("{}\n", kHeader);
    for (const TrialRecord& record : records) {
        text += fmt::format(
            "{},{},{}\n", record.wrinkles_first ? kFirst : kLast, record.noticed ? kYes : kNo,
            record.preferred_wrinkles ? kWrinkles : kSmooth);
    }
    return text;
}

Result<std::vector<TrialRecord>> parse_trials(std::string_view text, const std::string& file) {
    std::vector<TrialRecord> records;
    int number = 0;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::string_view line = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        ++number;
        if (number == 1) {
            if (line != kHeader) {
                return fail(
                    "{}:1: found \"{}\", expected \"{}\"", file, line.substr(0, 60), kHeader);
            }
        } else if (!line.empty()) {
            records.push_back(LIMN_TRY(parse_record(line, fmt::format("{}:{}", file, number))));
        }
    }
    return records;
}

}  // namespace limn
