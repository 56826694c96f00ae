#include "content/speech/unit_sound.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

// Techniques: face.align-resample, face.fragment-blend, face.speech-fragments

namespace limn {
namespace {

constexpr float kFade = 0.005f;     ///< half the length of a cross-fade [s]
constexpr float kSearch = 0.006f;   ///< how far a cut may move to a zero crossing [s]
constexpr double kSameTime = 1e-4;  ///< of two units that follow each other [s]

/// A unit in samples of the output; its own sample is `shift` later.
struct Piece {
    const Recording* sound = nullptr;
    std::int64_t begin = 0;
    std::int64_t end = 0;
    std::int64_t shift = 0;
    bool follows = false;  ///< the previous piece, without silence in between

    [[nodiscard]] float at(std::int64_t sample) const {
        const std::int64_t i = sample + shift;
        return i < 0 || i >= static_cast<std::int64_t>(sound->samples.size())
                   ? 0.0f
                   : static_cast<float>(sound->samples[static_cast<std::size_t>(i)]);
    }
    [[nodiscard]] bool rises_at(std::int64_t sample) const {
        return at(sample - 1) < 0.0f && at(sample) >= 0.0f;
    }
};

/// The rising zero crossing nearest to `sample`, or `sample` itself.
std::int64_t find_crossing(const Piece& piece, std::int64_t sample, std::int64_t search) {
    for (std::int64_t away = 0; away <= search; ++away) {
        for (const std::int64_t at : {sample - away, sample + away}) {
            if (piece.rises_at(at)) {
                return at;
            }
        }
    }
    return sample;
}

Piece make_piece(
    const SpeechTrack& target, const SelectedUnit& selected, const SpeechRecording& recording) {
    const auto samples = [&](float time) {
        return static_cast<std::int64_t>(
            std::llround(static_cast<double>(time) * recording.sound.rate));
    };
    const bool is_diphone = selected.unit.kind == UnitKind::Diphone;
    // Where both agree to the sample: a diphone between its sounds, since silence may be shorter.
    const std::size_t fixed = is_diphone ? 1 : 0;
    const SpeechSegment& first = target.segments[selected.at];
    const SpeechSegment& last = target.segments[selected.at + selected.unit.count - 1];
    Piece piece;
    piece.sound = &recording.sound;
    piece.shift = samples(recording.track.segments[selected.unit.first + fixed].start)
                  - samples(target.segments[selected.at + fixed].start);
    piece.begin = samples(is_diphone ? 0.5f * (first.start + first.end) : first.start);
    piece.end = samples(is_diphone ? 0.5f * (last.start + last.end) : last.end);
    return piece;
}

/// Moves the cut between two pieces, and the sound of the later, to a zero crossing of each.
void align(Piece& earlier, Piece& later, std::int64_t search) {
    const std::int64_t cut = find_crossing(earlier, later.begin, search);
    if (later.sound != earlier.sound || later.shift != earlier.shift) {
        later.shift += find_crossing(later, cut, search) - cut;
    }
    earlier.end = cut;
    later.begin = cut;
}

/// 0 before a cut, 1 after it.
float fade(std::int64_t since, float half) {
    return blend_weight(std::clamp(0.5f + 0.5f * static_cast<float>(since) / half, 0.0f, 1.0f));
}

}  // namespace

SpeechTrack pace_by_units(
    const SpeechTrack& target, std::span<const SelectedUnit> selected,
    std::span<const SpeechRecording> recordings) {
    std::vector<float> halves;
    for (const SpeechSegment& segment : target.segments) {
        halves.insert(halves.end(), 2, 0.5f * (segment.end - segment.start));
    }
    for (const SelectedUnit& one : selected) {
        const SpeechTrack& track = recordings[one.unit.recording].track;
        const bool is_diphone = one.unit.kind == UnitKind::Diphone;
        for (std::size_t i = 0; i < one.unit.count; ++i) {
            const SpeechSegment& source = track.segments[one.unit.first + i];
            const bool is_silent = source.sound.phoneme == 0;
            const float half = 0.5f * (source.end - source.start);
            for (std::size_t k = 0; k < 2; ++k) {
                if (!is_diphone || (i == 0) == (k == 1)) {
                    halves[2 * (one.at + i) + k] = is_silent ? std::min(half, kSpeechMargin) : half;
                }
            }
        }
    }
    SpeechTrack paced = target;
    float time = 0.0f;
    for (std::size_t i = 0; i < paced.segments.size(); ++i) {
        paced.segments[i].start = time;
        time += halves[2 * i] + halves[2 * i + 1];
        paced.segments[i].end = time;
    }
    return paced;
}

Recording join_sound(
    const SpeechTrack& target, std::span<const SelectedUnit> selected,
    std::span<const SpeechRecording> recordings) {
    Recording joined;
    std::vector<Piece> pieces;
    for (const SelectedUnit& one : selected) {
        const SpeechRecording& recording = recordings[one.unit.recording];
        if (recording.sound.samples.empty()
            || (!pieces.empty() && recording.sound.rate != pieces[0].sound->rate)) {
            return {};
        }
        Piece piece = make_piece(target, one, recording);
        piece.follows = !pieces.empty()
                        && static_cast<double>(std::abs(piece.begin - pieces.back().end))
                               <= kSameTime * recording.sound.rate + 1.0;
        pieces.push_back(piece);
    }
    if (pieces.empty()) {
        return {};
    }
    joined.rate = pieces[0].sound->rate;
    const auto rate = static_cast<float>(joined.rate);
    const float half = std::max(kFade * rate, 1.0f);
    const auto reach = static_cast<std::int64_t>(std::ceil(half));
    for (std::size_t i = 1; i < pieces.size(); ++i) {
        if (pieces[i].follows) {
            align(pieces[i - 1], pieces[i], static_cast<std::int64_t>(kSearch * rate));
        }
    }
    const auto count = static_cast<std::int64_t>(
        std::llround(static_cast<double>(target.duration()) * joined.rate));
    std::vector<float> sum(static_cast<std::size_t>(count), 0.0f);
    for (const Piece& piece : pieces) {
        const std::int64_t from = std::max<std::int64_t>(piece.begin - reach, 0);
        const std::int64_t to = std::min(piece.end + reach, count);
        for (std::int64_t t = from; t < to; ++t) {
            const float weight = fade(t - piece.begin, half) - fade(t - piece.end, half);
            sum[static_cast<std::size_t>(t)] += weight * piece.at(t);
        }
    }
    for (const float value : sum) {
        joined.samples.push_back(
            static_cast<std::int16_t>(std::lround(std::clamp(value, -32767.0f, 32767.0f))));
    }
    return joined;
}

}  // namespace limn
