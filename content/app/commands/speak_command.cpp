#include "content/app/commands/speak_command.h"

#include "content/load/files/atomic_file.h"
#include "content/load/gltf/gltf_clip.h"
#include "content/speech/face_clip.h"
#include "content/speech/head_motion.h"
#include "content/speech/speech_library.h"
#include "content/speech/utterance.h"
#include "ecs/base/text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <filesystem>
#include <set>
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

GltfFaceClip make_clip(
    const GltfFace& face, const std::vector<FaceNode>& nodes, const SpeechTrack& track,
    const SampledCurves& mouth, std::uint64_t seed) {
    const EyeTrack eyes = make_eye_track(track.duration(), seed);
    const auto frames = static_cast<std::size_t>(std::ceil(track.duration() * kRate)) + 1;
    GltfFaceClip clip{.name = "speech", .times = {}, .weights = {}, .head_rotations = {}};
    clip.weights.resize(face.nodes.size());
    for (std::size_t frame = 0; frame < frames; ++frame) {
        const float time = static_cast<float>(frame) / kRate;
        clip.times.push_back(time);
        for (std::size_t i = 0; i < face.nodes.size(); ++i) {
            const MouthPose pose = mouth_at(mouth, time);
            std::vector<float> row = nodes[i].expression;
            for (std::size_t s = 0; s < row.size(); ++s) {
                row[s] *=
                    moves_mouth(face.nodes[i].shapes[s]) ? mouth_expression_weight(pose) : 1.0f;
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
    for (std::size_t i = 0; i < face.nodes.size(); ++i) {
        for (std::size_t s = 0; s < face.nodes[i].shapes.size(); ++s) {
            const GltfShape& shape = face.nodes[i].shapes[s];
            units.insert(shape.action_unit.empty() ? shape.name : shape.action_unit);
            if (is_shape(shape, assignment.path)) {
                nodes[i].expression[s] = static_cast<float>(*weight);
                is_known = true;
            }
        }
    }
    if (!is_known) {
        return fail(
            "{}: found no shape \"{}\", expected one of {}", file, assignment.path,
            fmt::format("{}", fmt::join(units, " ")));
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

/// The motion of the mouth: from the recordings of a library, or by rules.
Result<SampledCurves> move_mouth(const SpeechTrack& track, const SpeakOptions& options) {
    if (options.fragments.empty()) {
        return record_mouth(options.text, track, kRate).motion;
    }
    const SpeechLibrary library = LIMN_TRY(load_speech_library(options.fragments));
    const std::vector<SpeechUnit> units = generate_units(library.recordings);
    const Result<std::vector<SelectedUnit>> selected =
        select_units(track, units, library.recordings, kJoinCost);
    if (!selected) {
        return fail("{}: {}", options.fragments, selected.error().message);
    }
    fmt::print("{}: {} recorded units\n", options.fragments, selected->size());
    return join_units(track, *selected, library.recordings, kRate);
}

/// Adds the utterance to a library, which is created if it does not exist.
Status record(const Utterance& utterance, const SpeakOptions& options) {
    SpeechLibrary library;
    if (std::filesystem::exists(options.record)) {
        library = LIMN_TRY(load_speech_library(options.record));
    }
    library.recordings.push_back(record_mouth(options.text, utterance.track, library.rate));
    return write_file(options.record, write_speech_library(library));
}

}  // namespace

Status run_speak(const SpeakOptions& options) {
    if (!options.out.ends_with(".glb")) {
        return fail("{}: expected a file name ending in .glb", options.out);
    }
    if (phrases_of(options.text).empty()) {
        return fail("limn speak: found a text without letters or digits, expected words to say");
    }
    const GltfFace face = LIMN_TRY(read_gltf_face(options.face));
    const std::vector<FaceNode> nodes = LIMN_TRY(link_face(face, options));
    const Utterance utterance = LIMN_TRY(utter(options));
    const SampledCurves mouth = LIMN_TRY(move_mouth(utterance.track, options));
    const GltfFaceClip clip = make_clip(face, nodes, utterance.track, mouth, options.seed);
    const std::vector<std::byte> bytes = LIMN_TRY(add_face_clip(options.face, face, clip));
    std::string sound = "no audio";
    if (!utterance.wave.samples.empty()) {
        sound = std::filesystem::path(options.out).replace_extension(".wav").string();
        LIMN_TRY(write_file(sound, write_wave(utterance.wave)));
    }
    LIMN_TRY(write_file(options.out, bytes));
    if (!options.record.empty()) {
        LIMN_TRY(record(utterance, options));
    }
    fmt::print(
        "{}: {:.2f} s, {} sounds, {}\n", options.out, utterance.track.duration(),
        utterance.track.segments.size(), sound);
    return Done{};
}

}  // namespace limn
