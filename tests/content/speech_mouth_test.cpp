#include "content/speech/coarticulation.h"
#include "content/speech/eyes.h"
#include "content/speech/face_clip.h"
#include "content/speech/head_motion.h"
#include "content/speech/mouth.h"
#include "tests/near.h"
#include "tests/support.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace limn::speech_mouth_test {
namespace {

SpeechTrack say(const char* text) {
    return make_speech_track(sounds_of_text(text));
}

float axis(const MouthPose& pose, MouthAxis which) {
    return pose[static_cast<std::size_t>(which)];
}

float middle_of(const SpeechTrack& track, const char* sound) {
    for (const SpeechSegment& segment : track.segments) {
        if (phonemes()[segment.sound.phoneme].name == sound) {
            return 0.5f * (segment.start + segment.end);
        }
    }
    FAIL("the track lacks the sound ", sound);
    return 0.0f;
}

}  // namespace

TEST_CASE(
    "dominance: two equal sounds and a strong one between weak ones blend as published"
    * technique("face.dominance")) {
    const std::vector<DominanceTarget> two{{0.0f, 1.0f}, {0.2f, 0.0f}};
    CHECK(blend_targets(two, 0.0f) == test::near(0.880797).epsilon(1e-5));
    CHECK(blend_targets(two, 0.1f) == test::near(0.5).epsilon(1e-5));
    CHECK(blend_targets(two, 0.2f) == test::near(0.119203).epsilon(1e-5));
    const std::vector<DominanceTarget> three{
        {0.0f, 0.2f, 0.1f}, {0.2f, 1.0f, 1.0f}, {0.4f, 0.0f, 0.1f}};
    CHECK(blend_targets(three, 0.2f) == test::near(0.976282).epsilon(1e-5));
    CHECK(blend_targets(three, 0.0f) == test::near(0.654962).epsilon(1e-5));
    CHECK(blend_targets(three, 0.4f) == test::near(0.572178).epsilon(1e-5));
}

TEST_CASE(
    "dominance: one sound is constant, blends stay within targets, and strengths are ratios"
    * technique("face.dominance")) {
    const std::vector<DominanceTarget> one{{0.5f, 0.7f}};
    std::vector<DominanceTarget> many{
        {0.1f, 0.3f, 0.5f, 8.0f, 15.0f},
        {0.2f, -0.4f, 1.0f},
        {0.5f, 0.9f, 0.2f, 12.0f, 9.0f, 2.0f}};
    std::vector<DominanceTarget> scaled = many;
    for (DominanceTarget& target : scaled) {
        target.strength *= 0.37f;
    }
    float last = blend_targets(many, -0.5f);
    for (float time = -0.5f; time < 1.0f; time += 0.001f) {
        const float value = blend_targets(many, time);
        CHECK(value >= -0.4f);
        CHECK(value <= 0.9f);
        CHECK(std::abs(value - last) < 0.02f);
        CHECK(blend_targets(scaled, time) == test::near(value).epsilon(1e-5).scale(1));
        CHECK(blend_targets(one, time) == test::near(0.7f));
        last = value;
    }
    CHECK(blend_targets(many, 1e4f, 0.25f) == 0.25f);
    CHECK(blend_targets({}, 0.0f, 0.25f) == 0.25f);
}

TEST_CASE(
    "mouth: lips close at p, b and m between wide vowels, and teeth meet the lip at f"
    * technique("face.viseme")) {
    for (const char* word : {"apa", "aba", "ama"}) {
        const SpeechTrack track = say(word);
        const MouthTrack mouth = make_mouth_track(track);
        const MouthPose closed = mouth_at(mouth, middle_of(track, std::string(1, word[1]).c_str()));
        CHECK(axis(closed, MouthAxis::LipsShut) > 0.85f);
        CHECK(axis(mouth_at(mouth, middle_of(track, "ae")), MouthAxis::LipsShut) < 0.35f);
    }
    const SpeechTrack track = say("afa");
    CHECK(
        axis(mouth_at(make_mouth_track(track), middle_of(track, "f")), MouthAxis::LipToTeeth)
        > 0.85f);
}

TEST_CASE(
    "mouth: lips round for the vowel of stew before it sounds" * technique("face.dominance")) {
    const SpeechTrack track = say("stew");
    const MouthTrack mouth = make_mouth_track(track);
    const float at_t = axis(mouth_at(mouth, middle_of(track, "t")), MouthAxis::Protrusion);
    const SpeechTrack flat = say("step");
    const float unrounded =
        axis(mouth_at(make_mouth_track(flat), middle_of(flat, "t")), MouthAxis::Protrusion);
    CHECK(at_t > 0.3f);
    CHECK(unrounded < 0.15f);
}

TEST_CASE("mouth: it opens most at open vowels, is at rest outside, and moves without jumps") {
    const SpeechTrack track = say("Hello, my father moved four big boats.");
    const MouthTrack mouth = make_mouth_track(track);
    const MouthPose rest{};
    CHECK(mouth_at(mouth, -1.0f) == rest);
    CHECK(mouth_at(mouth, 0.0f) == rest);
    CHECK(mouth_at(mouth, track.duration()) == rest);
    CHECK(mouth_at(make_mouth_track({}), 0.0f) == rest);
    MouthPose last{};
    for (float time = 0.0f; time < track.duration() + 0.1f; time += 0.001f) {
        const MouthPose pose = mouth_at(mouth, time);
        for (std::size_t i = 0; i < kMouthAxes; ++i) {
            CHECK(std::abs(pose[i]) <= 1.0f);
            CHECK(std::abs(pose[i] - last[i]) < 0.03f);
        }
        last = pose;
    }
    const SpeechTrack open = say("mama");
    const MouthTrack wide = make_mouth_track(open);
    CHECK(axis(mouth_at(wide, middle_of(open, "ae")), MouthAxis::Jaw) > 0.5f);
    CHECK(axis(mouth_of(Viseme::Silence), MouthAxis::Jaw) == 0.0f);
    CHECK(axis(mouth_of(Viseme::A), MouthAxis::Jaw) == 1.0f);
}

TEST_CASE("eyes: blinks, looks away and saccades have the rates and lengths that were measured") {
    constexpr float kHour = 3600.0f;
    const EyeTrack track = make_eye_track(kHour, 7);
    const double per_minute = static_cast<double>(track.blinks.size()) / 60.0;
    CHECK(per_minute > 22.0);  // 26 pauses a minute, and the blinks between them take time
    CHECK(per_minute < 26.0);
    double away = 0.0;
    std::size_t large = 0;
    for (std::size_t i = 0; i + 1 < track.shifts.size(); i += 2) {
        const GazeShift& shift = track.shifts[i];
        away += track.shifts[i + 1].start - shift.start;
        const float angle = std::hypot(shift.yaw, 2.0f * shift.pitch);
        large += angle > 15.0f ? 1 : 0;
        CHECK(shift.duration == test::near(0.021 + 0.0022 * angle).epsilon(1e-4));
        CHECK(track.shifts[i + 1].yaw == 0.0f);
    }
    CHECK(away / kHour == test::near(0.9 / 4.0).epsilon(0.1));
    CHECK(static_cast<double>(large) < 0.2 * 0.5 * static_cast<double>(track.shifts.size()));
    for (const Blink& blink : track.blinks) {
        CHECK(eyes_at(track, blink.start + blink.closing + 0.5f * blink.shut).closed == 1.0f);
        CHECK(eyes_at(track, blink.start).closed == 0.0f);
    }
    CHECK(eyes_at(track, kHour).closed == 0.0f);
    CHECK(eyes_at(track, kHour).yaw == 0.0f);
    CHECK(make_eye_track(60.0f, 7).blinks[0].start == track.blinks[0].start);
    CHECK(make_eye_track(60.0f, 8).blinks[0].start != track.blinks[0].start);
}

TEST_CASE("head: it rests at both ends of an utterance and turns by a few degrees between") {
    const SpeechTrack track = say("This is a longer sentence, and my head moves with it.");
    const Quat none(1, 0, 0, 0);
    CHECK(std::abs(glm::dot(head_at(track, 0.0f, 3), none)) == test::near(1.0f));
    CHECK(std::abs(glm::dot(head_at(track, track.duration(), 3), none)) == test::near(1.0f));
    float most = 0.0f;
    for (float time = 0.0f; time < track.duration(); time += 0.01f) {
        const float half = std::acos(std::min(std::abs(head_at(track, time, 3).w), 1.0f));
        most = std::max(most, 2.0f * half * 180.0f / kPi);
    }
    CHECK(most > 2.0f);
    CHECK(most < 7.0f);
}

TEST_CASE("face clip: shapes are found by action unit, halves are both used, best names first") {
    const std::vector<GltfShape> shapes{
        {"a", "AU26"},
        {"b", "AU27"},
        {"c", "AU20_L"},
        {"d", "AU20_R"},
        {"e", "AU2"},
        {"f", "AU18"},
        {"mouthRollLower", "AU28"},
        {"g", "AU45_L"},
        {"h", "AU43_R"}};
    const std::vector<FaceLink> links = link_shapes(shapes);
    REQUIRE(opens_mouth(links));
    MouthPose mouth{};
    mouth[static_cast<std::size_t>(MouthAxis::Jaw)] = 1.0f;
    mouth[static_cast<std::size_t>(MouthAxis::Width)] = 1.0f;
    std::vector<float> weights(shapes.size(), 0.0f);
    add_face_weights(links, mouth, {}, weights);
    CHECK(weights == std::vector<float>{0, 0.34f, 0.45f, 0.45f, 0, 0, 0, 0, 0});

    mouth[static_cast<std::size_t>(MouthAxis::LipsShut)] = 1.0f;
    weights.assign(shapes.size(), 0.0f);
    add_face_weights(links, mouth, {.closed = 1.0f}, weights);
    CHECK(weights[1] == 0.0f);
    CHECK(weights[7] == 1.0f);
    CHECK(weights[8] == 0.0f);
    CHECK(!opens_mouth(link_shapes(std::vector<GltfShape>{{"x", "AU12"}})));
}

TEST_CASE(
    "face clip: channels at zero leave the face at rest, and channels of other shapes add"
    * technique("face.categories")) {
    const std::vector<GltfShape> shapes{{"a", "AU26"}, {"b", "AU45"}, {"c", "AU61"}};
    const std::vector<FaceLink> links = link_shapes(shapes);
    std::vector<float> rest(3, 0.0f);
    add_face_weights(links, {}, {}, rest);
    CHECK(rest == std::vector<float>(3, 0.0f));
    MouthPose mouth{};
    mouth[0] = 0.5f;
    const EyePose eyes{.closed = 0.25f, .yaw = 20.0f};
    std::vector<float> both(3, 0.0f);
    std::vector<float> sum(3, 0.0f);
    add_face_weights(links, mouth, eyes, both);
    add_face_weights(links, mouth, {}, sum);
    add_face_weights(links, {}, eyes, sum);
    CHECK(both == sum);
    CHECK(both == std::vector<float>{0.45f, 0.25f, 0.5f});
}

TEST_CASE(
    "face clip: speech overrides the mouth of an expression, not the brows"
    * technique("face.categories")) {
    CHECK(moves_mouth({"smile", "AU12_L"}));
    CHECK(moves_mouth({"puff", "AU34"}));
    CHECK(!moves_mouth({"brow", "AU1"}));
    CHECK(!moves_mouth({"sneer", "AU9"}));
    CHECK(!moves_mouth({"neck", "AU21"}));
    CHECK(!moves_mouth({"AU12", ""}));
    CHECK(mouth_expression_weight({}) == 1.0f);
    MouthPose mouth{};
    mouth[1] = -0.75f;
    CHECK(mouth_expression_weight(mouth) == 0.25f);
    mouth[0] = 2.0f;
    CHECK(mouth_expression_weight(mouth) == 0.0f);
}

}  // namespace limn::speech_mouth_test
