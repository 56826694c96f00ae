#include "content/app/commands/import_markers.h"

#include "content/load/faces/marker_file.h"
#include "content/load/faces/marker_import.h"
#include "content/load/files/atomic_file.h"
#include "content/load/files/json_document.h"
#include "content/load/gltf/gltf_load.h"
#include "content/load/gltf/gltf_write.h"
#include "content/sound/scene_sound.h"
#include "content/speech/speech_library.h"
#include "content/speech/take_labels.h"
#include "content/speech/wave_file.h"
#include "ecs/base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <utility>

// Techniques: face.speech-fragments, face.unit-generate

namespace limn {
namespace {

Result<std::string> read_text(const std::string& path) {
    const std::vector<std::byte> bytes = LIMN_TRY(read_file(path));
    return std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

/// Writes the face with a clip in which it follows the markers. Returns what to print.
Result<std::string> write_performance(
    const ImportOptions& options, const FaceMarkers& markers, const MarkerMotion& motion) {
    const GltfFace face = LIMN_TRY(read_gltf_face(options.onto));
    GltfFaceClip clip{.name = "take", .times = {}, .weights = {}, .head_rotations = {}};
    clip.weights.resize(face.nodes.size());
    float largest = 0.0f;
    for (const std::vector<float>& row : drive_shapes(markers, motion)) {
        clip.times.push_back(static_cast<float>(clip.times.size()) / motion.rate);
        clip.head_rotations.push_back(face.head_rotation);
        for (std::size_t i = 0; i < face.nodes.size(); ++i) {
            std::vector<float> weights(face.nodes[i].shapes.size(), 0.0f);
            add_weights_by_name(face.nodes[i], markers.shapes, row, weights);
            clip.weights[i].insert(clip.weights[i].end(), weights.begin(), weights.end());
        }
        for (const float weight : row) {
            largest = std::max(largest, weight);
        }
    }
    const std::vector<std::byte> bytes = LIMN_TRY(add_face_clip(options.onto, face, clip));
    LIMN_TRY(write_file(options.out, bytes));
    return fmt::format(
        "{} markers drive {} shapes, weights up to {:.2f}, {:.2f} s", motion.markers(),
        markers.shapes.size(), largest, clip.times.back());
}

/// The mean of the first two channels of a sound in any format.
Result<Recording> load_one_channel(const std::string& path) {
    const SoundData sound = LIMN_TRY(load_sound(path));
    const auto channels = static_cast<std::size_t>(sound.channels);
    Recording mean{static_cast<std::uint32_t>(sound.rate), {}};
    for (std::size_t i = 0; i + channels <= sound.samples.size(); i += channels) {
        const float sum = sound.samples[i] + (channels > 1 ? sound.samples[i + 1] : 0.0f);
        const float sample = std::round(32768.0f * sum / static_cast<float>(channels));
        mean.samples.push_back(static_cast<std::int16_t>(std::clamp(sample, -32768.0f, 32767.0f)));
    }
    return mean;
}

/// The markers in the order of `names`, if these are the same ones.
MarkerMotion in_order_of(std::span<const std::string> names, const MarkerMotion& motion) {
    if (std::ranges::equal(names, motion.names)
        || !std::ranges::is_permutation(names, motion.names)) {
        return motion;
    }
    MarkerMotion sorted{{names.begin(), names.end()}, motion.rate, {}};
    for (std::size_t f = 0; f < motion.frames(); ++f) {
        for (const std::string& name : names) {
            const auto m = std::ranges::find(motion.names, name) - motion.names.begin();
            sorted.positions.push_back(
                motion.positions[f * motion.markers() + static_cast<std::size_t>(m)]);
        }
    }
    return sorted;
}

/// The take as marker channels with sound and labels.
Result<SpeechRecording>
record_take(const ImportOptions& options, const MarkerMotion& take, SpeechLibrary& library) {
    const MarkerMotion motion = in_order_of(library.markers, take);
    if (library.markers.empty() && library.recordings.empty()) {
        library.rate = motion.rate;
        library.markers = motion.names;
        library.rest.assign(
            motion.positions.begin(),
            motion.positions.begin() + static_cast<std::ptrdiff_t>(motion.markers()));
    }
    if (library.markers != motion.names) {
        for (const std::string& name : motion.names) {
            if (std::ranges::find(library.markers, name) == library.markers.end()) {
                const std::vector<std::string_view> known(
                    library.markers.begin(), library.markers.end());
                return fail(
                    "{}: the library {} has no marker {}{}", options.in, options.library,
                    in_quotes(name), did_you_mean(name, known));
            }
        }
        return fail(
            "{}: found {} markers, expected the {} of the library {}", options.in, motion.markers(),
            library.markers.size(), options.library);
    }
    SpeechRecording recording;
    recording.text = options.text;
    std::string sound = options.sound;
    if (sound.empty()) {
        sound = std::filesystem::path(options.in).replace_extension(".wav").string();
    }
    recording.sound = LIMN_TRY(load_one_channel(sound));
    const float covered = static_cast<float>(motion.frames() - 1) / motion.rate;
    const float duration = std::min(covered, recording.sound.duration());
    if (options.labels.empty()) {
        Recording heard = recording.sound;
        heard.samples.resize(static_cast<std::size_t>(duration * static_cast<float>(heard.rate)));
        Result<SpeechTrack> track = find_labels(heard, options.text);
        if (!track) {
            return fail("{}: {}", sound, track.error().message);
        }
        recording.track = *std::move(track);
    } else {
        const std::string labels = LIMN_TRY(read_text(options.labels));
        recording.track = LIMN_TRY(parse_labels(labels, options.labels, options.text, duration));
    }
    const auto& segments = recording.track.segments;
    if (segments.size() < 3 || segments.front().sound.phoneme != 0
        || segments.back().sound.phoneme != 0) {
        return fail(
            "{}: found speech at the start or at the end of the recording, expected silence there",
            options.in);
    }
    SampledCurves offsets{motion.rate, 3 * motion.markers(), {}};
    for (std::size_t i = 0; i < motion.positions.size(); ++i) {
        const Vec3 offset = motion.positions[i] - motion.positions[i % motion.markers()];
        offsets.values.insert(offsets.values.end(), {offset.x, offset.y, offset.z});
    }
    const CurveSpline spline(offsets);
    recording.motion = {library.rate, offsets.channels, {}};
    const auto rows = static_cast<std::size_t>(std::ceil(duration * library.rate)) + 1;
    for (std::size_t i = 0; i < rows; ++i) {
        std::vector<float> row(offsets.channels);
        spline.evaluate(std::min(static_cast<float>(i) / library.rate, covered), row);
        recording.motion.values.insert(recording.motion.values.end(), row.begin(), row.end());
    }
    return recording;
}

/// Adds the take to the library, and its sound beside it.
Status add_to_library(const ImportOptions& options, const MarkerMotion& motion) {
    if (options.text.empty()) {
        return fail("--library: found no --text, expected what is said in {}", options.in);
    }
    SpeechLibrary library;
    if (std::filesystem::exists(options.library)) {
        library = LIMN_TRY(load_speech_library(options.library));
    }
    SpeechRecording recording = LIMN_TRY(record_take(options, motion, library));
    const std::filesystem::path path(options.library);
    recording.sound_file =
        fmt::format("{}-{}.wav", path.stem().string(), library.recordings.size() + 1);
    const std::size_t sounds = recording.track.segments.size() - 2;
    LIMN_TRY(write_file(
        std::filesystem::path(path).replace_filename(recording.sound_file).string(),
        write_wave(recording.sound)));
    library.recordings.push_back(std::move(recording));
    LIMN_TRY(write_file(options.library, write_speech_library(library)));
    fmt::print(
        "{}: {} recording{} of {} markers, the last with {} sounds\n", options.library,
        library.recordings.size(), library.recordings.size() == 1 ? "" : "s",
        library.markers.size(), sounds);
    return Done{};
}

}  // namespace

Result<FaceMarkers> place_on_face(
    const std::string& face, std::span<const std::string> markers, const std::string& map) {
    std::vector<FaceMarkerPlace> places;
    if (!map.empty()) {
        const std::string text = LIMN_TRY(read_text(map));
        places = LIMN_TRY(parse_marker_map(text, map));
    }
    const GltfScene scene = LIMN_TRY(load_gltf(face));
    return place_markers(scene, markers, places, map);
}

void add_weights_by_name(
    const GltfFaceNode& node, std::span<const std::string> shapes, std::span<const float> row,
    std::span<float> weights) {
    for (std::size_t s = 0; s < node.shapes.size(); ++s) {
        const auto found = std::ranges::find(shapes, node.shapes[s].name);
        if (found != shapes.end()) {
            weights[s] += row[static_cast<std::size_t>(found - shapes.begin())];
        }
    }
}

Status import_marker_take(const ImportOptions& options) {
    if (!options.out.ends_with(".glb")) {
        return fail("{}: expected a file name ending in .glb", options.out);
    }
    if (!options.assignments.empty()) {
        return fail("--set: found {}, expected bvh", options.kind);
    }
    if (options.head && !options.onto.empty()) {
        return fail("--head: found --onto, expected one of them");
    }
    if (options.onto.empty() && (options.patches || !options.map.empty())) {
        return fail(
            "{}: found no --onto, expected a face", options.patches ? "--patches" : "--map");
    }
    const std::string name = std::filesystem::path(options.in).stem().string();
    const MarkerSurface surface = options.head ? make_head_marker_surface() : MarkerSurface{};
    std::string done;
    if (!options.onto.empty()) {
        MarkerMotion motion = LIMN_TRY(load_trc(options.in));
        motion = LIMN_TRY(isolate_face(name, std::move(motion)));
        const FaceMarkers markers =
            LIMN_TRY(place_on_face(options.onto, motion.names, options.map));
        motion = retarget_markers(motion, markers.points);
        if (options.patches) {
            const GltfScene scene = LIMN_TRY(make_marker_scene(name, motion));
            LIMN_TRY(save_glb(options.out, scene));
            done = fmt::format(
                "{} markers on the face, {} triangles, {:.2f} s", motion.markers(),
                scene.meshes[0].indices.size() / 3, scene.clips[0].duration);
        } else {
            done = LIMN_TRY(write_performance(options, markers, motion));
        }
    } else {
        const GltfScene scene =
            LIMN_TRY(import_markers(options.in, options.head ? &surface : nullptr));
        LIMN_TRY(save_glb(options.out, scene));
        done = fmt::format(
            "{} markers, {} triangles, {:.2f} s", scene.meshes[0].positions.size(),
            scene.meshes[0].indices.size() / 3, scene.clips[0].duration);
    }
    if (!options.library.empty()) {
        MarkerMotion motion = LIMN_TRY(load_trc(options.in));
        motion = LIMN_TRY(isolate_face(name, std::move(motion)));
        LIMN_TRY(add_to_library(options, motion));
    }
    fmt::print("{}: {}\n", options.out, done);
    return Done{};
}

}  // namespace limn
