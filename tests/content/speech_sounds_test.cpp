#include "content/speech/speech_track.h"
#include "content/speech/spelling.h"
#include "content/speech/utterance.h"
#include "tests/near.h"
#include "tests/support.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <set>
#include <string>

namespace limn::speech_sounds_test {
namespace {

std::string names(const std::vector<Sound>& sounds) {
    std::string text;
    for (const Sound& sound : sounds) {
        text += (text.empty() ? "" : " ") + std::string(phonemes()[sound.phoneme].name);
    }
    return text;
}

std::string spelled(const std::string& text) {
    return names(sounds_of_text(text));
}

}  // namespace

TEST_CASE(
    "speech: every sound has one viseme, p, b and m the same one, and silence is at rest"
    * technique("face.viseme")) {
    std::set<Viseme> visemes;
    std::set<std::string_view> unique;
    for (const Phoneme& phoneme : phonemes()) {
        visemes.insert(phoneme.viseme);
        unique.insert(phoneme.name);
        CHECK(static_cast<std::size_t>(phoneme.viseme) < kVisemes);
        CHECK(phoneme.duration >= 0.05f);
        CHECK(
            phonemes()[static_cast<std::size_t>(find_phoneme(phoneme.name))].name == phoneme.name);
    }
    CHECK(unique.size() == phonemes().size());
    CHECK(visemes.size() == kVisemes);
    for (const char* name : {"p", "b", "m"}) {
        CHECK(phonemes()[static_cast<std::size_t>(find_phoneme(name))].viseme == Viseme::P);
    }
    CHECK(phonemes()[0].viseme == Viseme::Silence);
    CHECK(find_phoneme("qq") == -1);
}

TEST_CASE("speech: English words are spelled as they sound" * technique("face.talking-head")) {
    CHECK(spelled("The time is now") == "dh ax t aa ih m ih z n aa uh");
    CHECK(
        spelled("exactly one in the afternoon")
        == "ih g z ae k t l iy w ah n ih n dh ax ae f t er n uw n");
    CHECK(spelled("fish") == "f ih sh");
    CHECK(spelled("phone") == "f ao uh n");
    CHECK(spelled("station") == "s t eh ih sh ax n");
    CHECK(spelled("light") == "l aa ih t");
    CHECK(spelled("knight") == "n aa ih t");
    CHECK(spelled("queen") == "k w iy n");
    CHECK(spelled("boats") == "b ao uh t s");
    CHECK(spelled("table") == "t eh ih b ax l");
    CHECK(spelled("playing") == "p l eh ih ih ng");
    CHECK(spelled("wanted") == "w ae n t ih d");
    CHECK(spelled("church") == "ch er ch");
    CHECK(spelled("judge") == "jh ah jh");
    CHECK(spelled("measure") == "m eh zh er");
    CHECK(spelled("stew") == "s t y uw");
}

TEST_CASE("speech: numbers are read") {
    CHECK(spelled("0") == spelled("zero"));
    CHECK(spelled("17") == spelled("seventeen"));
    CHECK(spelled("20") == spelled("twenty"));
    CHECK(spelled("42") == spelled("forty two"));
    CHECK(spelled("306") == spelled("three hundred six"));
    CHECK(spelled("2026") == spelled("two thousand twenty six"));
    CHECK(
        spelled("999999") == spelled("nine hundred ninety nine thousand nine hundred ninety nine"));
    CHECK(spelled("007") == spelled("zero zero seven"));
}

TEST_CASE("speech: any letters sound, and nothing else does") {
    for (char a = 'a'; a <= 'z'; ++a) {
        for (char b = 'a'; b <= 'z'; ++b) {
            for (char c = 'a'; c <= 'z'; ++c) {
                const std::string word{a, b, c};
                for (const Sound& sound : sounds_of_text(word)) {
                    REQUIRE(sound.phoneme > 0);
                }
            }
        }
    }
    CHECK(sounds_of_text("").empty());
    CHECK(sounds_of_text("?! \xc3\xa9 ...").empty());
    CHECK(sounds_of_ipa("").empty());
    CHECK(sounds_of_ipa("\xff\xfe ??").empty());
}

TEST_CASE("speech: punctuation makes silence, and words begin where they begin") {
    const std::vector<Sound> sounds = sounds_of_text("No, no no.");
    CHECK(names(sounds) == "n ao uh sil n ao uh n ao uh");
    CHECK(sounds[2].ends_phrase);
    CHECK(sounds.back().ends_phrase);
    CHECK(!sounds[6].ends_phrase);
    std::string starts;
    for (const Sound& sound : sounds) {
        starts += sound.starts_word ? '1' : '0';
    }
    CHECK(starts == "1000100100");
}

TEST_CASE("speech: the phonetic alphabet is read with stress, length and joined letters") {
    const std::vector<Sound> sounds = sounds_of_ipa("həlˈəʊ\nwˈɜːld tʃˈɑːns");
    CHECK(names(sounds) == "hh ax l ax uh sil w er l d ch aa n s");
    CHECK(!sounds[1].stressed);
    CHECK(sounds[3].stressed);
    CHECK(sounds[0].starts_word);
    CHECK(sounds[10].starts_word);
    CHECK(!sounds[11].starts_word);
    CHECK(!sounds_of_ipa("ˌaftənˈuːn")[0].stressed);
    CHECK(sounds_of_ipa("ˌaftənˈuːn")[5].stressed);
}

TEST_CASE(
    "speech: a track covers its time without gaps, and the last syllable is longest"
    * technique("face.viseme")) {
    const SpeechTrack track = make_speech_track(sounds_of_text("no no no"));
    REQUIRE(track.segments.size() == 11);
    CHECK(track.segments.front().start == 0.0f);
    CHECK(track.segments.front().end == kSpeechMargin);
    for (std::size_t i = 1; i < track.segments.size(); ++i) {
        CHECK(track.segments[i].start == track.segments[i - 1].end);
        CHECK(track.segments[i].end > track.segments[i].start);
    }
    const auto length = [&](std::size_t i) {
        return track.segments[i].end - track.segments[i].start;
    };
    CHECK(length(9) == test::near(1.4f * length(6)));
    CHECK(length(2) == test::near(1.2f * 0.13f));
    const SpeechTrack fast = make_speech_track(sounds_of_text("no no no"), 2.0f);
    CHECK(
        fast.duration() - 2.0f * kSpeechMargin
        == test::near(0.5f * (track.duration() - 2.0f * kSpeechMargin)));
    CHECK(make_speech_track({}).segments.empty());
    CHECK(SpeechTrack{}.duration() == 0.0f);
}

TEST_CASE(
    "speech: sounds of a phrase end with its audio, and phrases stay in step with theirs"
    * technique("face.talking-head")) {
    Recording wave{.rate = 8000, .samples = std::vector<std::int16_t>(4000, 0)};
    for (std::size_t i = 1000; i < 3000; ++i) {
        wave.samples[i] = i % 2 == 0 ? 8000 : -8000;
    }
    Utterance utterance;
    append_utterance(utterance, join_phrase(sounds_of_text("hello"), wave));
    append_utterance(utterance, join_phrase(sounds_of_text("big boats"), wave));
    CHECK(utterance.track.duration() == test::near(2 * (0.25 + 2 * kSpeechMargin)));
    CHECK(utterance.wave.duration() == test::near(utterance.track.duration()));
    for (std::size_t i = 1; i < utterance.track.segments.size(); ++i) {
        CHECK(utterance.track.segments[i].start == utterance.track.segments[i - 1].end);
    }
    // The second phrase's first sound and its first loud sample.
    const std::size_t first = sounds_of_text("hello").size() + 3;
    const float time = utterance.track.segments[first].start;
    const auto sample = static_cast<std::size_t>(time * 8000.0f + 0.5f);
    CHECK(utterance.wave.samples[sample - 1] == 0);
    CHECK(utterance.wave.samples[sample] != 0);
}

TEST_CASE(
    "speech: text is cut into phrases at its punctuation, and empty text says nothing"
    * technique("face.talking-head")) {
    CHECK(phrases_of("Yes, I do!  - ") == std::vector<std::string>{"Yes,", " I do!"});
    CHECK(phrases_of(" ... ?").empty());
    CHECK(spell_utterance("").track.segments.empty());
}

TEST_CASE("wave file: sound survives writing, and other files are refused in a line") {
    const Recording wave{.rate = 22050, .samples = {0, 100, -32768, 32767}};
    const std::vector<std::byte> bytes = write_wave(wave);
    const Result<Recording> read = parse_wave(bytes, "x.wav");
    REQUIRE(read.ok());
    CHECK(read->rate == wave.rate);
    CHECK(read->samples == wave.samples);

    std::vector<std::byte> piped = bytes;
    piped[40] = piped[41] = piped[42] = piped[43] = std::byte{0xff};
    CHECK(parse_wave(piped, "x.wav").value().samples == wave.samples);
    for (std::size_t size = 0; size < bytes.size(); ++size) {
        const Result<Recording> part = parse_wave(std::span(bytes).first(size), "x.wav");
        CHECK((part.ok() || part.error().message.starts_with("x.wav: found ")));
    }
    std::vector<std::byte> stereo = bytes;
    stereo[22] = std::byte{2};
    CHECK(
        parse_wave(stereo, "x.wav").error().message
        == "x.wav: found format 1 with 2 channels, 16 bits, 22050 samples per second, expected "
           "PCM with 1 channel and 16 bits");
    CHECK(audible_range({.rate = 1, .samples = {0, 5, 900, 0, -900, 3}}).first == 2);
    CHECK(audible_range({.rate = 1, .samples = {0, 5, 900, 0, -900, 3}}).end == 5);
    CHECK(audible_range({.rate = 1, .samples = {0, 5}}).end == 0);
}

}  // namespace limn::speech_sounds_test
