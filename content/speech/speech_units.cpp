#include "content/speech/speech_units.h"

#include "ecs/base/check.h"
#include "ecs/base/text.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

// Techniques: face.fragment-blend, face.speech-fragments, face.unit-generate, face.unit-select

namespace limn {

namespace {

constexpr float kOffsetDecay = 0.05f;  ///< time in which the offset of a hard join falls to 1/e [s]
constexpr double kUnreachable = std::numeric_limits<double>::infinity();

float center_time(const SpeechSegment& segment) {
    return 0.5f * (segment.start + segment.end);
}

bool is_silence(const SpeechSegment& segment) {
    return segment.sound.phoneme == 0;
}

/// A unit covers a range of half sounds of the utterance: sound i is the halves 2 i and 2 i + 1.
struct Candidate {
    SelectedUnit selected;
    std::size_t begin = 0;
    std::size_t end = 0;
    double cost = kUnreachable;    ///< of the best cover that ends with it
    std::ptrdiff_t previous = -1;  ///< the previous candidate, or -1: silence
};

bool has_sounds(
    const SpeechTrack& target, std::size_t at, const SpeechUnit& unit,
    const SpeechRecording& recording) {
    if (at + unit.count > target.segments.size()) {
        return false;
    }
    for (std::size_t i = 0; i < unit.count; ++i) {
        if (target.segments[at + i].sound.phoneme
            != recording.track.segments[unit.first + i].sound.phoneme) {
            return false;
        }
    }
    return true;
}

std::vector<Candidate> find_candidates(
    const SpeechTrack& target, std::span<const SpeechUnit> units,
    std::span<const SpeechRecording> recordings) {
    std::vector<Candidate> candidates;
    for (std::uint32_t at = 0; at < target.segments.size(); ++at) {
        for (const SpeechUnit& unit : units) {
            if (has_sounds(target, at, unit, recordings[unit.recording])) {
                const bool is_diphone = unit.kind == UnitKind::Diphone;
                const std::size_t begin = 2 * std::size_t{at} + (is_diphone ? 1 : 0);
                candidates.push_back(
                    {.selected = {unit, at},
                     .begin = begin,
                     .end = is_diphone ? begin + 2 : begin + 2 * std::size_t{unit.count}});
            }
        }
    }
    std::ranges::stable_sort(candidates, {}, &Candidate::begin);
    return candidates;
}

std::vector<float> pose_at(const SampledCurves& motion, float time) {
    std::vector<float> pose(motion.channels, 0.0f);
    if (motion.size() > 0) {
        CurveSpline(motion).evaluate(time, pose);
    }
    return pose;
}

/// Distance between the last pose of a unit and the first pose of the next; 0 for units that were
/// recorded one after the other.
float pose_distance(
    const SpeechUnit& a, const SpeechUnit& b, std::span<const SpeechRecording> recordings) {
    const float end = unit_end(a, recordings[a.recording]);
    const float start = unit_start(b, recordings[b.recording]);
    if (a.recording == b.recording && end == start) {
        return 0.0f;
    }
    const std::vector<float> from = pose_at(recordings[a.recording].motion, end);
    const std::vector<float> to = pose_at(recordings[b.recording].motion, start);
    float sum = 0.0f;
    for (std::size_t c = 0; c < std::min(from.size(), to.size()); ++c) {
        sum += (to[c] - from[c]) * (to[c] - from[c]);
    }
    return std::sqrt(sum);
}

/// Why no cover is complete: the first sound that no recording has, or the sounds after which the
/// longest cover ends.
Error explain_gap(
    const SpeechTrack& target, std::span<const SpeechRecording> recordings, std::size_t reached) {
    for (const SpeechSegment& segment : target.segments) {
        const bool is_recorded = std::ranges::any_of(recordings, [&](const SpeechRecording& one) {
            return std::ranges::any_of(one.track.segments, [&](const SpeechSegment& other) {
                return other.sound.phoneme == segment.sound.phoneme;
            });
        });
        if (!is_recorded && !is_silence(segment)) {
            return fail(
                "found no recording with the sound \"{}\", expected one of each sound of the text",
                phonemes()[segment.sound.phoneme].name);
        }
    }
    const std::size_t i = std::min(reached / 2, target.segments.size() - 1);
    const std::size_t next = std::min(i + 1, target.segments.size() - 1);
    return fail(
        "found no recording of \"{}\" before \"{}\", expected a word or a pair of sounds with it",
        phonemes()[target.segments[i].sound.phoneme].name,
        phonemes()[target.segments[next].sound.phoneme].name);
}

/// A unit on the time axis of the utterance, ready to be sampled.
struct StretchedUnit {
    CurveSpline spline;
    std::vector<float> source;  ///< boundaries in the recording
    std::vector<float> target;  ///< the same in the utterance
    float begin = 0.0f;         ///< interval of the utterance that it covers [s]
    float end = 0.0f;
};

StretchedUnit
stretch(const SpeechTrack& target, const SelectedUnit& selected, const SpeechRecording& recording) {
    StretchedUnit unit{CurveSpline(recording.motion), {}, {}, 0.0f, 0.0f};
    for (std::size_t i = 0; i < selected.unit.count; ++i) {
        unit.source.push_back(recording.track.segments[selected.unit.first + i].start);
        unit.target.push_back(target.segments[selected.at + i].start);
    }
    unit.source.push_back(
        recording.track.segments[selected.unit.first + selected.unit.count - 1].end);
    const SpeechSegment& last = target.segments[selected.at + selected.unit.count - 1];
    unit.target.push_back(last.end);
    const bool is_diphone = selected.unit.kind == UnitKind::Diphone;
    unit.begin = is_diphone ? center_time(target.segments[selected.at]) : unit.target.front();
    unit.end = is_diphone ? center_time(last) : unit.target.back();
    return unit;
}

void sample(const StretchedUnit& unit, float time, std::span<float> values) {
    unit.spline.evaluate(map_time(unit.target, unit.source, time), values);
}

/// Blends `row`, of the unit that contains `time`, with the unit on the other side of a join.
void blend_join(
    const StretchedUnit& earlier, const StretchedUnit& later, float time, float rate,
    std::span<float> row) {
    const float join = later.begin;
    if (earlier.end != join) {
        return;  // silence in between
    }
    const float half = 0.5f
                       * std::min(
                           earlier.target.back() - earlier.target[earlier.target.size() - 2],
                           later.target[1] - later.target[0]);
    const bool is_later = time >= join;
    std::vector<float> other(row.size());
    if (half * rate < 1.0f) {
        if (is_later) {
            std::vector<float> start(row.size());
            sample(earlier, join, other);
            sample(later, join, start);
            const float left = std::exp((join - time) / kOffsetDecay);
            for (std::size_t c = 0; c < row.size(); ++c) {
                row[c] += left * (other[c] - start[c]);
            }
        }
        return;
    }
    if (std::abs(time - join) < half) {
        const float weight = blend_weight(0.5f + 0.5f * (time - join) / half);
        sample(is_later ? earlier : later, time, other);
        for (std::size_t c = 0; c < row.size(); ++c) {
            row[c] += (is_later ? 1.0f - weight : weight) * (other[c] - row[c]);
        }
    }
}

}  // namespace

std::vector<SpeechUnit> generate_units(std::span<const SpeechRecording> recordings) {
    std::vector<SpeechUnit> units;
    for (std::uint32_t r = 0; r < recordings.size(); ++r) {
        const auto& segments = recordings[r].track.segments;
        const auto count = static_cast<std::uint32_t>(segments.size());
        if (count < 3) {
            continue;
        }
        units.push_back({UnitKind::Sentence, r, 1, count - 2});
        for (std::uint32_t first = 1; first + 1 < count;) {
            std::uint32_t end = first + 1;
            while (end + 1 < count && !segments[end].sound.starts_word
                   && !is_silence(segments[end])) {
                ++end;
            }
            if (!is_silence(segments[first])) {
                units.push_back({UnitKind::Word, r, first, end - first});
            }
            first = end;
        }
        for (std::uint32_t first = 0; first + 1 < count; ++first) {
            units.push_back({UnitKind::Diphone, r, first, 2});
        }
    }
    return units;
}

float unit_start(const SpeechUnit& unit, const SpeechRecording& recording) {
    const SpeechSegment& first = recording.track.segments[unit.first];
    return unit.kind == UnitKind::Diphone ? center_time(first) : first.start;
}

float unit_end(const SpeechUnit& unit, const SpeechRecording& recording) {
    const SpeechSegment& last = recording.track.segments[unit.first + unit.count - 1];
    return unit.kind == UnitKind::Diphone ? center_time(last) : last.end;
}

Result<std::vector<SelectedUnit>> select_units(
    const SpeechTrack& target, std::span<const SpeechUnit> units,
    std::span<const SpeechRecording> recordings, float join_cost) {
    const std::size_t halves = 2 * target.segments.size();
    std::vector<Candidate> candidates = find_candidates(target, units, recordings);
    // The best path to each boundary between half sounds: a cost and the candidate that ends there
    // or, after silence, before it.
    struct Arrival {
        std::ptrdiff_t candidate = -1;
        double cost = 0.0;
    };
    std::vector<std::vector<Arrival>> arrivals(halves + 1);
    arrivals[0].push_back({});
    std::size_t next = 0;
    std::size_t reached = 0;
    for (std::size_t at = 0; at < halves; ++at) {
        for (; next < candidates.size() && candidates[next].begin == at; ++next) {
            Candidate& candidate = candidates[next];
            for (const Arrival& arrival : arrivals[at]) {
                double cost = arrival.cost + 1.0;
                if (arrival.candidate >= 0) {
                    const Candidate& last = candidates[static_cast<std::size_t>(arrival.candidate)];
                    if (last.end == at) {
                        cost += join_cost
                                * pose_distance(
                                    last.selected.unit, candidate.selected.unit, recordings);
                    }
                }
                if (cost < candidate.cost) {
                    candidate.cost = cost;
                    candidate.previous = arrival.candidate;
                }
            }
            if (candidate.cost < kUnreachable) {
                arrivals[candidate.end].push_back(
                    {static_cast<std::ptrdiff_t>(next), candidate.cost});
            }
        }
        if (!arrivals[at].empty()) {
            reached = at;
            if (is_silence(target.segments[at / 2])) {
                const Arrival best = *std::ranges::min_element(arrivals[at], {}, &Arrival::cost);
                arrivals[at + 1].push_back(best);
            }
        }
    }
    if (arrivals[halves].empty()) {
        return explain_gap(target, recordings, reached);
    }
    std::vector<SelectedUnit> cover;
    for (std::ptrdiff_t i =
             std::ranges::min_element(arrivals[halves], {}, &Arrival::cost)->candidate;
         i >= 0; i = candidates[static_cast<std::size_t>(i)].previous) {
        cover.push_back(candidates[static_cast<std::size_t>(i)].selected);
    }
    std::ranges::reverse(cover);
    return cover;
}

SampledCurves join_units(
    const SpeechTrack& target, std::span<const SelectedUnit> selected,
    std::span<const SpeechRecording> recordings, float rate) {
    LIMN_CHECK(rate > 0.0f);
    std::vector<StretchedUnit> units;
    for (const SelectedUnit& one : selected) {
        units.push_back(stretch(target, one, recordings[one.unit.recording]));
    }
    SampledCurves result;
    result.rate = rate;
    result.channels = recordings.empty() ? 0 : recordings[0].motion.channels;
    const auto count = static_cast<std::size_t>(std::ceil(target.duration() * rate)) + 1;
    result.values.assign(count * result.channels, 0.0f);
    std::size_t u = 0;
    for (std::size_t i = 0; i < count && !units.empty(); ++i) {
        const float time = static_cast<float>(i) / rate;
        while (u + 1 < units.size() && time >= units[u].end) {
            ++u;
        }
        const std::span<float> row =
            std::span(result.values).subspan(i * result.channels, result.channels);
        sample(units[u], time, row);
        if (u + 1 < units.size()) {
            blend_join(units[u], units[u + 1], time, rate, row);
        }
        if (u > 0) {
            blend_join(units[u - 1], units[u], time, rate, row);
        }
        const float outside = std::max({units[u].begin - time, time - units[u].end, 0.0f});
        const float speaking = 1.0f - blend_weight(outside / kSpeechMargin);
        for (float& value : row) {
            value *= speaking;
        }
    }
    return result;
}

}  // namespace limn
