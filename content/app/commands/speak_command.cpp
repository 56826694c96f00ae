#include "content/app/commands/speak_command.h"

#include "content/app/commands/head_scene.h"
#include "content/app/commands/import_markers.h"
#include "content/load/files/atomic_file.h"
#include "content/load/gltf/gltf_clip.h"
#include "content/load/gltf/gltf_write.h"
#include "content/speech/face_clip.h"
#include "content/speech/head_motion.h"
#include "content/speech/speech_library.h"
#include "content/speech/unit_sound.h"
#include "content/speech/utterance.h"
#include "ecs/base/text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <set>
#include <span>
#include <string>
#include <system_error>
#include <unistd.h>
#include <utility>
#include <vector>

// Techniques: face.categories, face.talking-head

namespace limn {

namespace {

constexpr double kMaxWeight = 10.0;
constexpr float kRate = 60.0f;      ///< keys per second
constexpr float kJoinCost = 0.25f;  ///< of a jump by 1 on one axis of the mouth, against one join

/// A node of a face: its shapes, those used for speech, and the weight of each in the expression.
struct FaceNode {
    std::vector<FaceLink> links;
    std::vector<float> expression;
};

/// What a text becomes: timing, sound, and the motion of the mouth, either by its axes or by the
/// weights of the face's shapes.
struct Speech {
    SpeechTrack track;
    Recording wave;       ///< without samples: silent
    SampledCurves mouth;  ///< with the channels of a MouthPose
    std::vector<std::string> shapes;
    std::vector<std::vector<float>> weights;  ///< rows of `shapes` at kRate, or none
};

/// Adds the recorded weights to those of an expression, which yields where the mouth speaks.
void add_recorded(
    const GltfFaceNode& node, const Speech& speech, std::size_t frame, std::span<float> row) {
    const std::vector<float>& recorded = speech.weights[std::min(frame, speech.weights.size() - 1)];
    std::vector<float> own(row.size(), 0.0f);
    add_weights_by_name(node, speech.shapes, recorded, own);
    float engaged = 0.0f;
    for (std::size_t s = 0; s < row.size(); ++s) {
        engaged = std::max(engaged, moves_mouth(node.shapes[s]) ? own[s] : 0.0f);
    }
    for (std::size_t s = 0; s < row.size(); ++s) {
        row[s] = own[s] + row[s] * (moves_mouth(node.shapes[s]) ? 1.0f - engaged : 1.0f);
    }
}

GltfFaceClip make_clip(
    const GltfFace& face, const std::vector<FaceNode>& nodes, const Speech& speech,
    std::uint64_t seed) {
    const SpeechTrack& track = speech.track;
    const EyeTrack eyes = make_eye_track(track.duration(), seed);
    const auto frames = static_cast<std::size_t>(std::ceil(track.duration() * kRate)) + 1;
    GltfFaceClip clip{.name = "speech", .times = {}, .weights = {}, .head_rotations = {}};
    clip.weights.resize(face.nodes.size());
    for (std::size_t frame = 0; frame < frames; ++frame) {
        const float time = static_cast<float>(frame) / kRate;
        clip.times.push_back(time);
        for (std::size_t i = 0; i < face.nodes.size(); ++i) {
            const MouthPose pose = mouth_at(speech.mouth, time);
            std::vector<float> row = nodes[i].expression;
            for (std::size_t s = 0; s < row.size(); ++s) {
                row[s] *=
                    moves_mouth(face.nodes[i].shapes[s]) ? mouth_expression_weight(pose) : 1.0f;
            }
            if (!speech.weights.empty()) {
                add_recorded(face.nodes[i], speech, frame, row);
            }
            add_face_weights(nodes[i].links, pose, eyes_at(eyes, time), row);
            clip.weights[i].insert(clip.weights[i].end(), row.begin(), row.end());
        }
        clip.head_rotations.push_back(face.head_rotation * head_at(track, time, seed));
    }
    return clip;
}

/// Sets the weight of every shape with that name or action unit, including halves. Fails if the
/// face has none.
Status express(
    const GltfFace& face, const Assignment& assignment, const std::string& file,
    std::vector<FaceNode>& nodes) {
    const Result<double> weight = parse_number(assignment.value, -kMaxWeight, kMaxWeight);
    if (!weight) {
        return fail("--express {}: {}", assignment.path, weight.error().message);
    }
    bool is_known = false;
    std::set<std::string> units;
    std::set<std::string> shapes;
    for (std::size_t i = 0; i < face.nodes.size(); ++i) {
        for (std::size_t s = 0; s < face.nodes[i].shapes.size(); ++s) {
            const GltfShape& shape = face.nodes[i].shapes[s];
            shapes.insert(shape.name);
            if (!shape.action_unit.empty()) {
                units.insert(shape.action_unit);
            }
            if (is_shape(shape, assignment.path)) {
                nodes[i].expression[s] = static_cast<float>(*weight);
                is_known = true;
            }
        }
    }
    if (!is_known) {
        return fail(
            "{}: found no shape \"{}\", expected an action unit, {}, or a shape, {}", file,
            assignment.path, units.empty() ? "none" : fmt::format("{}", fmt::join(units, " ")),
            fmt::format("{}", fmt::join(shapes, " ")));
    }
    return Done{};
}

/// The nodes of a face with shapes; nodes that do not open the mouth, such as eyes and lashes, may
/// have few links or none.
Result<std::vector<FaceNode>> link_face(const GltfFace& face, const SpeakOptions& options) {
    std::vector<FaceNode> nodes;
    bool opens = false;
    for (const GltfFaceNode& node : face.nodes) {
        nodes.push_back({link_shapes(node.shapes), std::vector<float>(node.shapes.size(), 0.0f)});
        opens = opens || opens_mouth(nodes.back().links);
    }
    if (!opens) {
        return fail(
            "{}: found no shape that opens the mouth, expected one with the action unit AU26 or "
            "AU27",
            options.face);
    }
    for (const Assignment& assignment : options.expression) {
        LIMN_TRY(express(face, assignment, options.face, nodes));
    }
    return nodes;
}

/// Phonemes from espeak-ng, or else from spelling rules.
Result<Utterance> utter(const SpeakOptions& options) {
    if (options.silent) {
        return spell_utterance(options.text);
    }
    if (!has_espeak()) {
        fmt::print(
            stderr, "limn speak: found no program espeak-ng: pronounced by rules, without audio\n");
        return spell_utterance(options.text);
    }
    return speak_utterance(options.text, options.voice);
}

/// Speech from recordings: their motion, and their sound where they have it, at their pace.
Result<Speech> speak_fragments(const Utterance& spoken, const SpeakOptions& options) {
    const SpeechLibrary library = LIMN_TRY(load_speech_library(options.fragments));
    // Takes are labeled by spelling rules (take_labels.h), so that their words are found by these.
    const Utterance utterance = library.markers.empty() ? spoken : spell_utterance(options.text);
    const std::vector<SpeechUnit> units = generate_units(library.recordings);
    const Result<std::vector<SelectedUnit>> selected =
        select_units(utterance.track, units, library.recordings, kJoinCost);
    if (!selected) {
        return fail("{}: {}", options.fragments, selected.error().message);
    }
    Speech speech{utterance.track, utterance.wave, {}, {}, {}};
    const SpeechTrack paced = pace_by_units(utterance.track, *selected, library.recordings);
    Recording joined = join_sound(paced, *selected, library.recordings);
    const bool has_sound = !joined.samples.empty();
    if (has_sound) {
        speech.track = paced;
        speech.wave = std::move(joined);
    }
    fmt::print(
        "{}: {} recorded units, {}\n", options.fragments, selected->size(),
        has_sound ? "with their sound" : "without sound of their own");
    SampledCurves motion = join_units(speech.track, *selected, library.recordings, kRate);
    if (library.markers.empty()) {
        speech.mouth = std::move(motion);
        return speech;
    }
    const FaceMarkers places = LIMN_TRY(place_on_face(options.face, library.markers, options.map));
    MarkerMotion markers{library.markers, kRate, library.rest};  // the first frame is at rest
    for (std::size_t i = 0; i < motion.size(); ++i) {
        for (std::size_t m = 0; m < library.markers.size(); ++m) {
            const std::span<const float> offset = motion.row(i).subspan(3 * m, 3);
            markers.positions.push_back(library.rest[m] + Vec3(offset[0], offset[1], offset[2]));
        }
    }
    speech.shapes = places.shapes;
    speech.weights = drive_shapes(places, retarget_markers(markers, places.points));
    speech.weights.erase(speech.weights.begin());
    return speech;
}

/// The motion of the mouth: from the recordings of a library, or by rules.
Result<Speech> make_speech(const Utterance& utterance, const SpeakOptions& options) {
    if (!options.fragments.empty()) {
        return speak_fragments(utterance, options);
    }
    return Speech{
        utterance.track,
        utterance.wave,
        record_mouth(options.text, utterance.track, kRate).motion,
        {},
        {}};
}

/// Adds the utterance to a library, which is created if it does not exist.
Status record(const Utterance& utterance, const SpeakOptions& options) {
    SpeechLibrary library;
    if (std::filesystem::exists(options.record)) {
        library = LIMN_TRY(load_speech_library(options.record));
    }
    if (!library.markers.empty()) {
        return fail(
            "{}: found recordings of markers, expected a library that --record wrote",
            options.record);
    }
    library.recordings.push_back(record_mouth(options.text, utterance.track, library.rate));
    return write_file(options.record, write_speech_library(library));
}

}  // namespace

namespace {

/// Speaks with a face that is a file.
Status speak_file(const SpeakOptions& options) {
    const GltfFace face = LIMN_TRY(read_gltf_face(options.face));
    const std::vector<FaceNode> nodes = LIMN_TRY(link_face(face, options));
    const Utterance utterance = LIMN_TRY(utter(options));
    const Speech speech = LIMN_TRY(make_speech(utterance, options));
    const GltfFaceClip clip = make_clip(face, nodes, speech, options.seed);
    const std::vector<std::byte> bytes = LIMN_TRY(add_face_clip(options.face, face, clip));
    std::string sound = "silent: no .wav is written";
    if (!speech.wave.samples.empty()) {
        sound = std::filesystem::path(options.out).replace_extension(".wav").string();
        LIMN_TRY(write_file(sound, write_wave(speech.wave)));
    }
    LIMN_TRY(write_file(options.out, bytes));
    if (!options.record.empty()) {
        LIMN_TRY(record(utterance, options));
    }
    fmt::print(
        "{}: {:.2f} s, {} phonemes, {}\n", options.out, speech.track.duration(),
        speech.track.segments.size(), sound);
    return Done{};
}

}  // namespace

Status run_speak(const SpeakOptions& options) {
    if (!options.out.ends_with(".glb")) {
        return fail("{}: expected a file name ending in .glb", options.out);
    }
    if (phrases_of(options.text).empty()) {
        return fail("limn speak: found a text without letters or digits, expected words to say");
    }
    if (!options.map.empty() && options.fragments.empty()) {
        return fail("--map: found no --fragments, expected a library with markers");
    }
    if (!is_head_name(options.face)) {
        return speak_file(options);
    }
    SpeakOptions own = options;
    own.face = fmt::format("{}.{}.glb", options.out, getpid());  // no one's file
    const GltfScene head = LIMN_TRY(make_head_scene(options.face));
    LIMN_TRY(save_glb(own.face, head));
    Status spoken = speak_file(own);
    std::error_code ignored;
    std::filesystem::remove(own.face, ignored);
    return spoken;
}

}  // namespace limn
