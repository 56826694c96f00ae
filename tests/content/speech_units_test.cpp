#include "content/speech/speech_library.h"
#include "content/speech/speech_units.h"
#include "tests/near.h"
#include "tests/support.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace limn::speech_units_test {
namespace {

constexpr float kRate = 60.0f;

std::vector<SpeechRecording> record(const std::vector<std::string>& texts) {
    std::vector<SpeechRecording> recordings;
    for (const std::string& text : texts) {
        recordings.push_back(record_mouth(text, make_speech_track(sounds_of_text(text)), kRate));
    }
    return recordings;
}

SpeechTrack say(const char* text) {
    return make_speech_track(sounds_of_text(text));
}

const std::vector<std::string> kClock{
    "the time is now", "exactly one", "exactly two", "in the morning", "in the afternoon"};

SampledCurves curves_of(const std::function<float(float)>& f, std::size_t count, float rate) {
    SampledCurves curves{rate, 1, {}};
    for (std::size_t i = 0; i < count; ++i) {
        curves.values.push_back(f(static_cast<float>(i) / rate));
    }
    return curves;
}

float value_at(const SampledCurves& curves, float time) {
    float value = 0.0f;
    CurveSpline(curves).evaluate(time, std::span(&value, 1));
    return value;
}

/// Radial basis functions r^3 with a linear part through all samples, by a dense solve.
double dense_rbf(const SampledCurves& curves, double time) {
    const std::size_t n = curves.size();
    const std::size_t size = n + 2;
    std::vector<double> a(size * (size + 1), 0.0);
    const auto at = [&](std::size_t row, std::size_t column) -> double& {
        return a[row * (size + 1) + column];
    };
    const auto t = [&](std::size_t i) { return static_cast<double>(i) / double{curves.rate}; };
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < n; ++j) {
            at(i, j) = std::pow(std::abs(t(i) - t(j)), 3.0);
        }
        at(i, n) = at(n, i) = 1.0;
        at(i, n + 1) = at(n + 1, i) = t(i);
        at(i, size) = curves.values[i];
    }
    for (std::size_t k = 0; k < size; ++k) {
        std::size_t pivot = k;
        for (std::size_t row = k + 1; row < size; ++row) {
            pivot = std::abs(at(row, k)) > std::abs(at(pivot, k)) ? row : pivot;
        }
        for (std::size_t column = 0; column <= size; ++column) {
            std::swap(at(k, column), at(pivot, column));
        }
        for (std::size_t row = 0; row < size; ++row) {
            const double factor = row == k ? 0.0 : at(row, k) / at(k, k);
            for (std::size_t column = 0; column <= size; ++column) {
                at(row, column) -= factor * at(k, column);
            }
        }
    }
    double sum = at(n, size) / at(n, n) + time * at(n + 1, size) / at(n + 1, n + 1);
    for (std::size_t i = 0; i < n; ++i) {
        sum += at(i, size) / at(i, i) * std::pow(std::abs(time - t(i)), 3.0);
    }
    return sum;
}

/// The fewest units that cover `target` from half sound `at` on, by trying all.
std::size_t fewest_units(
    const SpeechTrack& target, const std::vector<SpeechUnit>& units,
    const std::vector<SpeechRecording>& recordings, std::size_t at) {
    constexpr std::size_t kNone = 1000;
    if (at >= 2 * target.segments.size()) {
        return 0;
    }
    std::size_t fewest = kNone;
    if (target.segments[at / 2].sound.phoneme == 0) {
        fewest = fewest_units(target, units, recordings, at + 1);
    }
    for (const SpeechUnit& unit : units) {
        const bool is_diphone = unit.kind == UnitKind::Diphone;
        if ((at % 2 == 1) != is_diphone || at / 2 + unit.count > target.segments.size()) {
            continue;
        }
        bool fits = true;
        for (std::size_t i = 0; i < unit.count; ++i) {
            fits =
                fits
                && target.segments[at / 2 + i].sound.phoneme
                       == recordings[unit.recording].track.segments[unit.first + i].sound.phoneme;
        }
        if (fits) {
            const std::size_t next = is_diphone ? at + 2 : at + 2 * std::size_t{unit.count};
            fewest = std::min(fewest, 1 + fewest_units(target, units, recordings, next));
        }
    }
    return fewest;
}

}  // namespace

TEST_CASE(
    "speech units: words cover a sentence once, and p sounds have p + 1 diphones"
    * technique("face.unit-generate")) {
    const std::vector<SpeechRecording> recordings = record({"the time is now"});
    const std::size_t sounds = recordings[0].track.segments.size() - 2;
    std::vector<int> covered(sounds + 2, 0);
    std::size_t words = 0;
    std::size_t diphones = 0;
    for (const SpeechUnit& unit : generate_units(recordings)) {
        const float start = unit_start(unit, recordings[0]);
        const float end = unit_end(unit, recordings[0]);
        CHECK(start < end);
        CHECK(start >= 0.0f);
        CHECK(end <= recordings[0].track.duration());
        if (unit.kind == UnitKind::Word) {
            ++words;
            for (std::size_t i = 0; i < unit.count; ++i) {
                ++covered[unit.first + i];
            }
        }
        diphones += unit.kind == UnitKind::Diphone ? 1 : 0;
    }
    CHECK(words == 4);
    CHECK(diphones == sounds + 1);
    covered.front() += 1;
    covered.back() += 1;
    CHECK(covered == std::vector<int>(sounds + 2, 1));
}

TEST_CASE(
    "unit selection: a recorded sentence is one unit and is replayed as it was recorded"
    * technique("face.speech-fragments, face.unit-select")) {
    const std::vector<SpeechRecording> recordings = record(kClock);
    const SpeechTrack target = say("exactly two");
    const auto placed = select_units(target, generate_units(recordings), recordings, 0.25f);
    REQUIRE(placed.ok());
    REQUIRE(placed->size() == 1);
    CHECK((*placed)[0].unit.kind == UnitKind::Sentence);
    CHECK((*placed)[0].unit.recording == 2);
    const SampledCurves motion = join_units(target, *placed, recordings, kRate);
    REQUIRE(motion.values.size() == recordings[2].motion.values.size());
    for (std::size_t i = 9; i + 10 < motion.size(); ++i) {  // without the margins
        for (std::size_t c = 0; c < kMouthAxes; ++c) {
            CHECK(
                motion.row(i)[c]
                == test::near(recordings[2].motion.row(i)[c]).epsilon(1e-4).scale(1));
        }
    }
}

TEST_CASE(
    "unit selection: any sentence of the clock is made of its phrases"
    * technique("face.speech-fragments")) {
    const std::vector<SpeechRecording> recordings = record(kClock);
    const std::vector<SpeechUnit> units = generate_units(recordings);
    for (const char* hour : {"one", "two"}) {
        for (const char* half : {"morning", "afternoon"}) {
            const std::string text =
                std::string("the time is now exactly ") + hour + " in the " + half;
            const SpeechTrack target = say(text.c_str());
            const auto placed = select_units(target, units, recordings, 0.25f);
            REQUIRE(placed.ok());
            CHECK(placed->size() == 3);
            std::size_t next = 1;
            for (const SelectedUnit& unit : *placed) {
                CHECK(unit.at == next);
                next += unit.unit.count;
            }
            CHECK(next == target.segments.size() - 1);
        }
    }
}

TEST_CASE(
    "unit selection: without a cost of jumps the cover is as small as by exhaustive search"
    * technique("face.unit-select")) {
    const std::vector<SpeechRecording> recordings = record({"no time", "time is", "is no", "mine"});
    const std::vector<SpeechUnit> units = generate_units(recordings);
    for (const char* text : {"no time is no time", "mine is no", "time mine", "is is is", "nine"}) {
        const SpeechTrack target = say(text);
        const std::size_t fewest = fewest_units(target, units, recordings, 0);
        const auto placed = select_units(target, units, recordings, 0.0f);
        CHECK(placed.ok() == (fewest < 1000));
        if (placed.ok()) {
            CHECK(placed->size() == fewest);
        }
    }
}

TEST_CASE(
    "unit selection: a high cost of jumps selects more units that fit better"
    * technique("face.unit-select")) {
    std::vector<SpeechRecording> recordings = record({"one two", "three", "one", "two"});
    const SpeechTrack target = say("one two three");
    // "one two" now ends far from where "three" starts; single words do not.
    for (float& value : recordings[0].motion.values) {
        value += 5.0f;
    }
    const std::vector<SpeechUnit> units = generate_units(recordings);
    const auto cost = [&](const std::vector<SelectedUnit>& cover) {
        std::vector<float> from(kMouthAxes);
        std::vector<float> to(kMouthAxes);
        float jumps = 0.0f;
        for (std::size_t i = 1; i < cover.size(); ++i) {
            const SpeechRecording& a = recordings[cover[i - 1].unit.recording];
            const SpeechRecording& b = recordings[cover[i].unit.recording];
            CurveSpline(a.motion).evaluate(unit_end(cover[i - 1].unit, a), from);
            CurveSpline(b.motion).evaluate(unit_start(cover[i].unit, b), to);
            float sum = 0.0f;
            for (std::size_t c = 0; c < kMouthAxes; ++c) {
                sum += (from[c] - to[c]) * (from[c] - to[c]);
            }
            jumps += std::sqrt(sum);
        }
        return jumps;
    };
    const auto cheap = select_units(target, units, recordings, 0.0f);
    const auto dear = select_units(target, units, recordings, 10.0f);
    REQUIRE(cheap.ok());
    REQUIRE(dear.ok());
    CHECK(cheap->size() == 2);
    CHECK(dear->size() > 2);
    CHECK(cost(*dear) < cost(*cheap));
}

TEST_CASE("unit selection: missing sounds are named" * technique("face.unit-select")) {
    const std::vector<SpeechRecording> recordings = record({"no time"});
    const std::vector<SpeechUnit> units = generate_units(recordings);
    CHECK(
        select_units(say("fish"), units, recordings, 0.0f).error().message
        == "found no recording with the sound \"f\", expected one of each sound of the text");
    CHECK(
        select_units(say("my"), units, recordings, 0.0f).error().message
        == "found no recording of \"m\" before \"aa\", expected a word or a pair of sounds with "
           "it");
}

TEST_CASE(
    "resampling: the spline is the radial basis function r^3 with a linear part"
    * technique("face.align-resample")) {
    const SampledCurves curves = curves_of(
        [](float t) { return std::sin(9.0f * t) + 0.3f * std::cos(31.0f * t); }, 12, 30.0f);
    for (double time = -0.05; time < 0.42; time += 0.007) {
        CHECK(
            value_at(curves, static_cast<float>(time))
            == test::near(dense_rbf(curves, time)).epsilon(2e-4).scale(1));
    }
}

TEST_CASE(
    "resampling: samples are kept, lines are exact, and twice the duration halves the speed"
    * technique("face.align-resample")) {
    const auto wave = [](float t) { return std::sin(7.0f * t); };
    const SampledCurves curves = curves_of(wave, 40, 60.0f);
    for (std::size_t i = 0; i < curves.size(); ++i) {
        CHECK(
            value_at(curves, static_cast<float>(i) / 60.0f)
            == test::near(curves.values[i]).scale(1));
    }
    const SampledCurves line = curves_of([](float t) { return 2.0f - 3.0f * t; }, 20, 60.0f);
    for (float time = -0.1f; time < 0.5f; time += 0.013f) {
        CHECK(value_at(line, time) == test::near(2.0f - 3.0f * time).epsilon(1e-5).scale(1));
    }
    CHECK(value_at(curves_of(wave, 1, 60.0f), 3.0f) == 0.0f);

    const std::vector<float> source{0.0f, 0.1f, 0.3f};
    const std::vector<float> target{1.0f, 1.2f, 1.6f};
    CHECK(map_time(target, source, 1.0f) == test::near(0.0f).scale(1));
    CHECK(map_time(target, source, 1.2f) == test::near(0.1f));
    CHECK(map_time(target, source, 1.6f) == test::near(0.3f));
    CHECK(map_time(target, source, 1.7f) == test::near(0.35f));
    const float step = 0.01f;
    const float slow = value_at(curves, map_time(target, source, 1.1f + step))
                       - value_at(curves, map_time(target, source, 1.1f));
    const float fast = value_at(curves, 0.05f + step) - value_at(curves, 0.05f);
    CHECK(slow == test::near(0.5f * fast).epsilon(0.02));
}

TEST_CASE(
    "blending: the weight is smooth, symmetric and flat at both ends"
    * technique("face.fragment-blend")) {
    CHECK(blend_weight(0.0f) == 0.0f);
    CHECK(blend_weight(0.5f) == 0.5f);
    CHECK(blend_weight(1.0f) == 1.0f);
    CHECK(blend_weight(-1.0f) == 0.0f);
    CHECK(blend_weight(0.001f) < 1e-5f);
    CHECK(1.0f - blend_weight(0.999f) < 1e-5f);
    for (float s = 0.0f; s <= 1.0f; s += 0.05f) {
        CHECK(blend_weight(s) + blend_weight(1.0f - s) == test::near(1.0f));
    }
}

TEST_CASE(
    "joining: the motion lasts as long as the utterance and has no jumps at joins"
    * technique("face.fragment-blend, face.speech-fragments")) {
    std::vector<SpeechRecording> recordings = record(kClock);
    for (float& value : recordings[1].motion.values) {
        value += 0.4f;  // so that joins have something to blend
    }
    const SpeechTrack target = say("the time is now exactly one in the afternoon");
    const auto placed = select_units(target, generate_units(recordings), recordings, 0.0f);
    REQUIRE(placed.ok());
    constexpr float kFine = 1000.0f;
    const SampledCurves motion = join_units(target, *placed, recordings, kFine);
    CHECK(
        static_cast<float>(motion.size() - 1) / kFine
        == test::near(target.duration()).epsilon(1e-3));
    for (std::size_t i = 1; i < motion.size(); ++i) {
        for (std::size_t c = 0; c < kMouthAxes; ++c) {
            CHECK(std::abs(motion.row(i)[c] - motion.row(i - 1)[c]) < 0.06f);
        }
    }
    // At 12 samples a second half a sound is less than a sample: the offset fades instead.
    const SampledCurves coarse = join_units(target, *placed, recordings, 12.0f);
    for (const float value : coarse.values) {
        CHECK(std::isfinite(value));
        CHECK(std::abs(value) < 2.0f);
    }
}

TEST_CASE(
    "speech library: recordings survive writing, and bad ones are rejected with their position"
    * technique("face.unit-generate")) {
    SpeechLibrary library{kRate, {}, {}, record({"exactly one", "two"})};
    const std::string text = write_speech_library(library);
    const Result<SpeechLibrary> read = parse_speech_library(text, "x.json");
    REQUIRE(read.ok());
    REQUIRE(read->recordings.size() == 2);
    CHECK(read->recordings[0].motion.values == library.recordings[0].motion.values);
    CHECK(write_speech_library(*read) == text);

    const auto error = [](const std::string& json) {
        const Result<SpeechLibrary> result = parse_speech_library(json, "x.json");
        return result ? "" : result.error().message;
    };
    CHECK(
        error("{}")
        == "x.json:1:1: found an object, expected a \"rate\" from 1 to 1000 samples per second");
    const std::string head = "{\"rate\": 60, \"recordings\": [{\n\"sounds\": [";
    CHECK(
        error(head + "{\"name\": \"qq\", \"end\": 1}]}]}")
        == "x.json:2:21: found the string \"qq\", expected the name of a sound, as \"sil\" or "
           "\"ae\"");
    CHECK(
        error(head + "{\"name\": \"sil\", \"end\": 0}]}]}")
        == "x.json:2:35: found the number 0, expected an \"end\" after 0 s");
    CHECK(
        error(head + "{\"name\": \"sil\", \"end\": 1}]}]}")
        == "x.json:2:11: found an array of 1, expected sounds between two of \"sil\"");
    const std::string sounds =
        head
        + "{\"name\": \"sil\", \"end\": 0.1}, {\"name\": \"ae\", \"end\": 0.2}, "
          "{\"name\": \"sil\", \"end\": 0.3}],\n\"samples\": [";
    CHECK(
        error(sounds + "[0, 0, 0, 0, 0]]}]}")
        == "x.json:3:12: found 1 samples, which last 0.016666668 s, expected them to cover the "
           "sounds, 0.3 s");
    CHECK(error(sounds + "[0, 0]]}]}") == "x.json:3:13: found an array of 2, expected 5 numbers");
    CHECK(
        error(sounds + "[0, 0, 0, 0, 1e9]]}]}")
        == "x.json:3:26: found the number 1e9, expected a number from -10 to 10");
}

}  // namespace limn::speech_units_test
