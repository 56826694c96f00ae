#include "content/load/files/atomic_file.h"
#include "content/speech/utterance.h"
#include "tests/support.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace limn::utterance_test {
namespace {

using test::TemporaryFolder;

/// Sets an environment variable for the scope of the object.
class Variable {
  public:
    Variable(const char* name, const std::string& value) : name_(name) {
        const char* const old = std::getenv(name);
        was_set_ = old != nullptr;
        old_ = was_set_ ? old : "";
        setenv(name, value.c_str(), 1);
    }
    Variable(const Variable&) = delete;
    Variable& operator=(const Variable&) = delete;
    ~Variable() {
        if (was_set_) {
            setenv(name_, old_.c_str(), 1);
        } else {
            unsetenv(name_);
        }
    }

  private:
    const char* name_;
    bool was_set_ = false;
    std::string old_;
};

/// A folder with a program espeak-ng that runs `script`, in which $file is where to write the sound
/// and $phrase what to say. It is the only one in PATH but for those of /bin; temporary files go to
/// the folder `temporary` in it.
struct FakeEspeak {
    TemporaryFolder folder;
    Variable path{"PATH", folder.path() + ":/bin"};
    Variable temporary{"TMPDIR", folder.file("temporary")};

    explicit FakeEspeak(const std::string& script) {
        std::filesystem::create_directory(folder.file("temporary"));
        std::ofstream program(folder.file("espeak-ng"));
        program << "#!/bin/sh\nwhile [ $# -gt 1 ]; do [ \"$1\" = -w ] && file=$2; shift; done\n"
                << "phrase=$1\nhere='" << folder.path() << "'\n"
                << script << "\n";
        program.close();
        std::filesystem::permissions(folder.file("espeak-ng"), std::filesystem::perms::owner_all);
    }
    /// A tone with silence before and after it, all in seconds.
    void add_tone(const std::string& name, float before, float tone, float after) const {
        Recording wave;
        const auto samples = [&](float time) {
            return static_cast<std::size_t>(time * static_cast<float>(wave.rate));
        };
        wave.samples.assign(samples(before), 0);
        wave.samples.resize(wave.samples.size() + samples(tone), 9000);
        wave.samples.resize(wave.samples.size() + samples(after), 0);
        REQUIRE(write_file(folder.file(name), write_wave(wave)));
    }
    [[nodiscard]] bool left_nothing() const {
        return std::filesystem::is_empty(folder.file("temporary"));
    }
};

constexpr const char* kCopyTone = R"(
case $phrase in
--version) ;;
*one*) cp "$here/one.wav" "$file"; echo 'wˈʌn' ;;
*) cp "$here/two.wav" "$file"; echo 'tˈuː θɹˈiː' ;;
esac)";

}  // namespace

TEST_CASE(
    "utterance: the clip is as long as the sound, and each phrase has the same time in both") {
    const FakeEspeak espeak(kCopyTone);
    espeak.add_tone("one.wav", 0.3f, 0.5f, 0.7f);
    espeak.add_tone("two.wav", 0.0f, 1.1f, 0.2f);
    CHECK(has_espeak());
    const Result<Utterance> said = speak_utterance("one, two three!", "en");
    REQUIRE(said);
    const float margins = 2 * kSpeechMargin;
    CHECK(std::abs(said->wave.duration() - (0.5f + 1.1f + 2 * margins)) < 1e-3f);
    CHECK(std::abs(said->track.duration() - said->wave.duration()) < 1e-3f);
    const Result<Utterance> one = speak_utterance("one,", "en");
    REQUIRE(one);
    CHECK(std::abs(one->track.duration() - (0.5f + margins)) < 1e-3f);
    // The second phrase begins at the end of the sound of the first.
    const std::size_t first = one->track.segments.size();
    REQUIRE(said->track.segments.size() > first);
    CHECK(std::abs(said->track.segments[first].start - one->wave.duration()) < 1e-3f);
    CHECK(espeak.left_nothing());
}

TEST_CASE("utterance: without the program, nothing is spoken and one line says so") {
    const TemporaryFolder empty;
    const Variable path("PATH", empty.path());
    CHECK(!has_espeak());
    const Result<Utterance> said = speak_utterance("One.", "en");
    REQUIRE(!said);
    CHECK(said.error().message.starts_with("espeak-ng: found no sound"));
    CHECK(said.error().message.find('\n') == std::string::npos);
    CHECK(!spell_utterance("One.").track.segments.empty());
}

TEST_CASE("utterance: a program that fails, writes nothing or no sound gives an error, and leaves "
          "no files") {
    const char* scripts[] = {
        "exit 3",                                  // fails
        "kill -9 $$",                              // is killed
        "echo 'wˈʌn'",                             // writes no file
        "echo 'wˈʌn'; echo 'no wave' >\"$file\"",  // what it writes is no sound
        "cp \"$here/one.wav\" \"$file\"; exit 1"};
    for (const char* const script : scripts) {
        CAPTURE(script);
        const FakeEspeak espeak(script);
        espeak.add_tone("one.wav", 0, 0.5f, 0);
        const Result<Utterance> said = speak_utterance("One.", "xx");
        REQUIRE(!said);
        CHECK(said.error().message.find("found") != std::string::npos);
        CHECK(said.error().message.find('\n') == std::string::npos);
        CHECK(espeak.left_nothing());
    }
}

TEST_CASE("utterance: without a folder for temporary files, one line says so") {
    const Variable temporary("TMPDIR", "/no/such/folder");
    const Result<Utterance> said = speak_utterance("One.", "en");
    REQUIRE(!said);
    CHECK(said.error().message.find('\n') == std::string::npos);
}

TEST_CASE("utterance: the sound of a phrase is never that of the one before") {
    const FakeEspeak espeak(
        "echo 'wˈʌn'; case $phrase in *one*) cp \"$here/one.wav\" \"$file\" ;; esac");
    espeak.add_tone("one.wav", 0, 0.5f, 0);
    CHECK(speak_utterance("one.", "en"));
    CHECK(!speak_utterance("one. two.", "en"));
}

TEST_CASE("utterance: espeak-ng itself says a text as long as its sounds are made, or is missing") {
    const Result<Utterance> said = speak_utterance("Hello there. This is a test.", "en-us");
    CHECK(static_cast<bool>(said) == has_espeak());
    if (said) {
        CHECK(said->wave.duration() > 1.5f);
        CHECK(std::abs(said->track.duration() - said->wave.duration()) < 1e-3f);
        CHECK(said->track.segments.size() > 15);
        const Result<Utterance> unknown = speak_utterance("Hello.", "xx-unknown");
        REQUIRE(!unknown);
        CHECK(unknown.error().message.find("xx-unknown") != std::string::npos);
    }
}

}  // namespace limn::utterance_test
