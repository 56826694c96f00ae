#include "content/speech/word_alignment.h"

#include "content/speech/phonemes.h"
#include "ecs/base/check.h"
#include "ecs/base/math.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

// Techniques: face.unit-generate

namespace limn {
namespace {

constexpr double kFullTurn = 6.283185307179586;  ///< [rad]
constexpr double kHop = 0.005;                   ///< between frames [s]
constexpr double kWindow = 0.02;                 ///< of a frame [s]
constexpr double kGrid = 50.0;                   ///< between frequencies of its spectrum [Hz]
constexpr double kHighest = 7500.0;              ///< [Hz]
constexpr double kFloor = 1e-6;        ///< power below that of the loudest frame, which is silence
constexpr std::size_t kBands = 16;     ///< of equal width in mel
constexpr std::size_t kAside = 4;      ///< frames on each side of an end that are compared
constexpr std::size_t kMinFrames = 3;  ///< of a sound
constexpr float kMaxStretch = 4.0f;    ///< of a duration

// By trial, on synthesized voices.
constexpr float kDurationCost = 4.0f;       ///< of a duration that is e times the usual one
constexpr float kChangeGain = 6.0f;         ///< of the largest change of a phrase
constexpr float kKindCost = 0.1f;           ///< of a frame one spread from its kind
constexpr float kLoudnessSpread = 8.0f;     ///< within a kind [dB]
constexpr float kBrightnessSpread = 12.0f;  ///< likewise

/// What a kind of sounds is like: loudness below that of the loud frames of a phrase, and power
/// above 3 kHz relative to that below 1 kHz [dB].
struct SoundKind {
    std::string_view phonemes;  ///< between spaces
    float loudness = 0.0f;
    float brightness = 0.0f;
};

constexpr std::array kKinds{
    SoundKind{" aa ae ah ax eh er ih iy ao uh uw ", -4, -20},
    SoundKind{" m n ng l r w y ", -10, -26},
    SoundKind{" b d g ", -18, -18},
    SoundKind{" p t k ", -26, -5},
    SoundKind{" v dh z zh jh ", -15, -5},
    SoundKind{" s sh ch ", -14, 10},
    SoundKind{" f th hh ", -22, 0},
};

std::size_t kind_of(const Sound& sound) {
    const std::string name = " " + std::string(phonemes()[sound.phoneme].name) + " ";
    const auto found = std::ranges::find_if(kKinds, [&](const SoundKind& kind) {
        return kind.phonemes.find(name) != std::string_view::npos;
    });
    return found == kKinds.end() ? 0 : static_cast<std::size_t>(found - kKinds.begin());
}

struct HeardFrame {
    std::array<float, kBands> bands{};  ///< [dB]
    float loudness = 0.0f;              ///< [dB]
    float brightness = 0.0f;            ///< [dB]
};

float decibels(double power) {
    return static_cast<float>(10.0 * std::log10(power));
}

double mel(double frequency) {
    return std::log(1.0 + frequency / 700.0);
}

/// Power at multiples of kGrid around a time, of the Hann window.
std::vector<double> spectrum_at(const Recording& recording, double time) {
    const double rate = recording.rate;
    const auto length = static_cast<std::ptrdiff_t>(kWindow * rate);
    const auto first = static_cast<std::ptrdiff_t>(time * rate) - length / 2;
    const auto count = static_cast<std::size_t>(std::min(kHighest, 0.5 * rate) / kGrid);
    std::vector<double> windowed;
    for (std::ptrdiff_t i = 0; i < length; ++i) {
        const std::ptrdiff_t at = first + i;
        const bool inside = at >= 0 && at < static_cast<std::ptrdiff_t>(recording.samples.size());
        const double hann =
            0.5 - 0.5 * std::cos(kFullTurn * static_cast<double>(i) / static_cast<double>(length));
        windowed.push_back(inside ? hann * recording.samples[static_cast<std::size_t>(at)] : 0.0);
    }
    std::vector<double> power;
    for (std::size_t k = 1; k <= count; ++k) {
        // Goertzel's recurrence.
        const double turn = kFullTurn * kGrid * static_cast<double>(k) / rate;
        const double twice = 2.0 * std::cos(turn);
        double last = 0.0;
        double before = 0.0;
        for (const double x : windowed) {
            const double next = x + twice * last - before;
            before = last;
            last = next;
        }
        power.push_back(last * last + before * before - twice * last * before);
    }
    return power;
}

std::vector<HeardFrame> hear(const Recording& recording, double begin, std::size_t frames) {
    std::vector<std::vector<double>> spectra;
    double loudest = 1.0;
    for (std::size_t f = 0; f < frames; ++f) {
        spectra.push_back(spectrum_at(recording, begin + (static_cast<double>(f) + 0.5) * kHop));
        double sum = 0.0;
        for (const double power : spectra.back()) {
            sum += power;
        }
        loudest = std::max(loudest, sum);
    }
    const double floor = kFloor * loudest;
    std::vector<HeardFrame> heard(frames);
    for (std::size_t f = 0; f < frames; ++f) {
        std::array<double, kBands> bands{};
        double low = floor;
        double high = floor;
        double all = floor;
        for (std::size_t k = 0; k < spectra[f].size(); ++k) {
            const double frequency = kGrid * static_cast<double>(k + 1);
            const double share = mel(frequency) / mel(kHighest);
            const auto band = static_cast<std::size_t>(share * static_cast<double>(kBands));
            bands[std::min(band, kBands - 1)] += spectra[f][k];
            low += frequency < 1000.0 ? spectra[f][k] : 0.0;
            high += frequency > 3000.0 ? spectra[f][k] : 0.0;
            all += spectra[f][k];
        }
        for (std::size_t b = 0; b < kBands; ++b) {
            heard[f].bands[b] = decibels(bands[b] + floor);
        }
        heard[f].loudness = decibels(all);
        heard[f].brightness = decibels(high / low);
    }
    // Relative to the loud frames.
    std::vector<float> loudness;
    for (const HeardFrame& frame : heard) {
        loudness.push_back(frame.loudness);
    }
    const auto loud =
        loudness.begin() + static_cast<std::ptrdiff_t>(9 * (loudness.size() - 1) / 10);
    std::ranges::nth_element(loudness, loud);
    for (HeardFrame& frame : heard) {
        frame.loudness -= *loud;
    }
    return heard;
}

/// How much the mean spectrum differs on both sides of the start of each frame, 0 .. 1.
std::vector<float> changes_of(const std::vector<HeardFrame>& heard) {
    std::vector<float> changes(heard.size() + 1, 0.0f);
    for (std::size_t f = 1; f < heard.size(); ++f) {
        const std::size_t aside = std::min({kAside, f, heard.size() - f});
        double sum = 0.0;
        for (std::size_t b = 0; b < kBands; ++b) {
            double difference = 0.0;
            for (std::size_t k = 0; k < aside; ++k) {
                difference +=
                    static_cast<double>(heard[f + k].bands[b]) - heard[f - 1 - k].bands[b];
            }
            sum += square(difference / static_cast<double>(aside));
        }
        changes[f] = static_cast<float>(std::sqrt(sum));
    }
    const float largest = *std::ranges::max_element(changes);
    for (float& change : changes) {
        change /= std::max(largest, 1e-6f);
    }
    return changes;
}

/// Costs of each kind from the first frame up to each.
std::vector<std::array<float, kKinds.size()>> sum_costs(const std::vector<HeardFrame>& heard) {
    std::vector<std::array<float, kKinds.size()>> sums(heard.size() + 1);
    for (std::size_t f = 0; f < heard.size(); ++f) {
        for (std::size_t k = 0; k < kKinds.size(); ++k) {
            const float loud = (heard[f].loudness - kKinds[k].loudness) / kLoudnessSpread;
            const float bright = (heard[f].brightness - kKinds[k].brightness) / kBrightnessSpread;
            const float away = std::min(loud * loud, 9.0f) + std::min(bright * bright, 9.0f);
            sums[f + 1][k] = sums[f][k] + kKindCost * away;
        }
    }
    return sums;
}

}  // namespace

std::vector<float> align_sounds(
    const Recording& recording, float begin, float end, std::span<const Sound> sounds,
    std::span<const float> usual) {
    LIMN_CHECK(sounds.size() == usual.size() && !sounds.empty());
    float total = 0.0f;
    for (const float duration : usual) {
        total += duration;
    }
    std::vector<float> ends;
    for (const float duration : usual) {
        ends.push_back((ends.empty() ? begin : ends.back()) + duration / total * (end - begin));
    }
    ends.back() = end;
    const auto frames = static_cast<std::size_t>(std::max(0.0f, end - begin) / kHop);
    constexpr std::size_t kMaxFrames = 6000;  // 30 s without a pause: the search is quadratic
    if (frames < kMinFrames * sounds.size() || frames > kMaxFrames) {
        return ends;
    }
    const std::vector<HeardFrame> heard = hear(recording, begin, frames);
    const std::vector<float> changes = changes_of(heard);
    const std::vector<std::array<float, kKinds.size()>> costs = sum_costs(heard);
    constexpr float kNever = std::numeric_limits<float>::infinity();
    std::vector<float> best(frames + 1, kNever);
    best[0] = 0.0f;
    std::vector<std::vector<std::uint32_t>> starts;  // of each sound, by its end
    for (std::size_t i = 0; i < sounds.size(); ++i) {
        const std::size_t kind = kind_of(sounds[i]);
        const float expected = static_cast<float>(frames) * usual[i] / total;
        const auto longest =
            std::max(static_cast<std::size_t>(kMaxStretch * expected), 2 * kMinFrames);
        std::vector<float> lasting(longest + 1);  // cost by duration
        for (std::size_t d = kMinFrames; d <= longest; ++d) {
            lasting[d] = kDurationCost * square(std::log(static_cast<float>(d) / expected));
        }
        std::vector<float> next(frames + 1, kNever);
        std::vector<std::uint32_t>& start = starts.emplace_back(frames + 1, 0);
        for (std::size_t f = kMinFrames; f <= frames; ++f) {
            for (std::size_t d = kMinFrames; d <= std::min(longest, f); ++d) {
                const float cost = best[f - d] + costs[f][kind] - costs[f - d][kind] + lasting[d]
                                   - kChangeGain * changes[f];
                if (cost < next[f]) {
                    next[f] = cost;
                    start[f] = static_cast<std::uint32_t>(f - d);
                }
            }
        }
        best = std::move(next);
    }
    if (!(best[frames] < kNever)) {
        return ends;
    }
    std::size_t at = frames;
    for (std::size_t i = sounds.size() - 1; i > 0; --i) {
        at = starts[i][at];
        ends[i - 1] = begin + static_cast<float>(static_cast<double>(at) * kHop);
    }
    return ends;
}

}  // namespace limn
