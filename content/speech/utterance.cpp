#include "content/speech/utterance.h"

#include "content/load/files/atomic_file.h"
#include "ecs/base/text.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

// Techniques: face.talking-head

namespace limn {

namespace {

constexpr std::string_view kProgram = "espeak-ng";
constexpr std::string_view kPauses = ".,;:!?\n";
constexpr std::size_t kMaxOutput = std::size_t{1} << 20;

bool is_spoken(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
}

/// A temporary folder, removed at the end of the scope.
struct TemporaryFolder {
    std::filesystem::path path;

    explicit TemporaryFolder(std::filesystem::path folder) : path(std::move(folder)) {}
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path, ignored);
    }
};

Result<std::string> make_folder() {
    std::error_code error;
    const std::filesystem::path parent = std::filesystem::temp_directory_path(error);
    if (error) {
        return fail(
            "{}: found no folder for temporary files, expected one (TMPDIR): {}", kProgram,
            error.message());
    }
    std::string path = parent / "limn-speech-XXXXXX";
    if (mkdtemp(path.data()) == nullptr) {
        return fail("{}: {}", path, std::strerror(errno));
    }
    return path;
}

struct ProgramOutput {
    int status = 0;  ///< of the program; 127: not found
    std::string text;
};

/// Runs a program, found in PATH, and collects what it prints.
Result<ProgramOutput> run_program(std::vector<std::string> arguments) {
    std::array<int, 2> ends{};
    if (pipe(ends.data()) != 0) {
        return fail("{}: {}", arguments[0], std::strerror(errno));
    }
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
    posix_spawn_file_actions_addclose(&actions, ends[0]);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", 1, 0);
    std::vector<char*> words;
    for (std::string& argument : arguments) {
        words.push_back(argument.data());
    }
    words.push_back(nullptr);
    pid_t process = 0;
    const int error = posix_spawnp(&process, words[0], &actions, nullptr, words.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    ProgramOutput output;
    if (error != 0) {
        close(ends[0]);
        output.status = 127;
        return output;
    }
    std::array<char, 4096> buffer{};
    for (ssize_t count = 0; (count = read(ends[0], buffer.data(), buffer.size())) > 0;) {
        if (output.text.size() < kMaxOutput) {
            output.text.append(buffer.data(), static_cast<std::size_t>(count));
        }
    }
    close(ends[0]);
    waitpid(process, &output.status, 0);
    return output;
}

}  // namespace

std::vector<std::string> phrases_of(std::string_view text) {
    std::vector<std::string> phrases;
    std::string phrase;
    const auto end_phrase = [&] {
        if (std::ranges::any_of(phrase, is_spoken)) {
            phrases.push_back(phrase);
        }
        phrase.clear();
    };
    for (const char c : text) {
        phrase.push_back(c);
        if (kPauses.find(c) != std::string_view::npos) {
            end_phrase();
        }
    }
    end_phrase();
    return phrases;
}

Utterance spell_utterance(std::string_view text) {
    Utterance utterance;
    for (const std::string& phrase : phrases_of(text)) {
        append_track(utterance.track, make_speech_track(sounds_of_text(phrase)));
    }
    return utterance;
}

Utterance join_phrase(std::span<const Sound> sounds, const Recording& wave) {
    const WaveRange audible = audible_range(wave);
    Utterance phrase;
    phrase.track = make_speech_track(sounds);
    const float spoken =
        static_cast<float>(audible.end - audible.first) / static_cast<float>(wave.rate);
    if (spoken > 0.0f) {
        fit_duration(phrase.track, spoken + 2.0f * kSpeechMargin);
    }
    const auto margin =
        static_cast<std::size_t>(kSpeechMargin * static_cast<float>(wave.rate) + 0.5f);
    phrase.wave.rate = wave.rate;
    phrase.wave.samples.assign(margin, 0);
    phrase.wave.samples.insert(
        phrase.wave.samples.end(),
        wave.samples.begin() + static_cast<std::ptrdiff_t>(audible.first),
        wave.samples.begin() + static_cast<std::ptrdiff_t>(audible.end));
    phrase.wave.samples.resize(phrase.wave.samples.size() + margin, 0);
    return phrase;
}

void append_utterance(Utterance& utterance, const Utterance& next) {
    append_track(utterance.track, next.track);
    utterance.wave.rate = next.wave.rate;
    utterance.wave.samples.insert(
        utterance.wave.samples.end(), next.wave.samples.begin(), next.wave.samples.end());
}

bool has_espeak() {
    const Result<ProgramOutput> output = run_program({std::string(kProgram), "--version"});
    return output && output->status == 0;
}

Result<Utterance> speak_utterance(std::string_view text, const std::string& voice) {
    const TemporaryFolder folder(LIMN_TRY(make_folder()));
    const std::string file = folder.path / "phrase.wav";
    Utterance utterance;
    for (const std::string& phrase : phrases_of(text)) {
        std::error_code absent;  // the first time
        std::filesystem::remove(file, absent);
        const ProgramOutput output = LIMN_TRY(
            run_program({std::string(kProgram), "-v", voice, "--ipa", "-w", file, "--", phrase}));
        const Result<std::vector<std::byte>> bytes = read_file(file);
        if (output.status != 0 || !bytes) {
            return fail(
                "{}: found no sound for the voice \"{}\", expected one of {} --voices", kProgram,
                voice, kProgram);
        }
        const Recording wave = LIMN_TRY(parse_wave(*bytes, file));
        append_utterance(utterance, join_phrase(sounds_of_ipa(output.text), wave));
    }
    return utterance;
}

}  // namespace limn
