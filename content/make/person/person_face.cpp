#include "content/make/person/person_face.h"

#include "content/bake/tangents.h"
#include "content/make/head/head_visemes.h"
#include "content/make/person/person_head_shape.h"
#include "content/speech/face_clip.h"
#include "content/speech/utterance.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>

// Techniques: char.morph-target

namespace limn {

namespace {

constexpr float kMinFaceShift = 2e-5f;  ///< of a vertex that a shape moves [m]

struct PersonFaceShape {
    std::string_view name;
    std::array<UnitWeight, 3> units;
};

constexpr std::array<PersonFaceShape, kPersonFaceShapes> kFaceShapes = {{
    {"AU26", {{{"AU26", 1.0f}, {"AU25", 0.3f}}}},
    {"AU20", {{{"AU20", 1.0f}, {"AU25", 0.5f}}}},
    {"AU18", {{{"AU18", 0.8f}, {"AU22", 0.5f}}}},
    {"AU24", {{{"AU24", 1.0f}}}},
    {"AU12", {{{"AU12", 1.0f}, {"AU6", 0.6f}}}},
    {"AU45", {{{"AU45", 1.0f}, {"AU43", 0.14f}}}},
    {"AU1", {{{"AU1", 1.0f}, {"AU2", 0.8f}}}},
    {"AU4", {{{"AU4", 1.0f}}}},
}};

std::uint16_t face_shape_index(std::string_view name) {
    const auto found = std::ranges::find(kFaceShapes, name, &PersonFaceShape::name);
    return static_cast<std::uint16_t>(found - kFaceShapes.begin());
}

/// A clip of one shape.
ClipData make_weight_clip(
    const char* name, std::uint16_t target, std::vector<float> times, std::vector<float> weights) {
    ClipData clip;
    clip.name = name;
    clip.duration = times.back();
    ClipSheet sheet;
    sheet.times = std::move(times);
    sheet.morphing = {target};
    sheet.weights = std::move(weights);
    clip.sheets.push_back(std::move(sheet));
    return clip;
}

ClipData make_person_talk(std::uint16_t first) {
    constexpr std::string_view kSays =
        "Good evening! How are you? We came down the hill this morning, with oranges and melons. "
        "You should see the harbor, it is full of boats.";
    constexpr float kSilence = 1.6f;  ///< before it is said again [s]
    constexpr float kRate = 30.0f;    ///< keys per second
    const SpeechTrack track = spell_utterance(kSays).track;
    const MouthTrack mouth = make_mouth_track(track);
    std::vector<GltfShape> shapes;
    for (const PersonFaceShape& shape : kFaceShapes) {
        shapes.push_back({std::string(shape.name), std::string(shape.name)});
    }
    const std::vector<FaceLink> links = link_shapes(shapes);
    ClipData clip;
    clip.name = "talk";
    ClipSheet sheet;
    for (const char* const moved : {"AU26", "AU20", "AU18", "AU24"}) {
        sheet.morphing.push_back(static_cast<std::uint16_t>(first + face_shape_index(moved)));
    }
    const auto frames = static_cast<int>(std::ceil((track.duration() + kSilence) * kRate));
    for (int frame = 0; frame <= frames; ++frame) {
        const float time = static_cast<float>(frame) / kRate;
        std::array<float, kPersonFaceShapes> weights{};
        add_face_weights(links, mouth_at(mouth, time), {}, weights);
        for (const std::uint16_t target : sheet.morphing) {
            sheet.weights.push_back(weights[target - first]);
        }
        sheet.times.push_back(time);
    }
    clip.duration = sheet.times.back();
    clip.sheets.push_back(std::move(sheet));
    return clip;
}

}  // namespace

bool has_face_shapes(const PersonShape& shape) {
    return shape.triangles == 0 || shape.triangles >= kMinFaceTriangles;
}

void add_face_shapes(MeshData& mesh, std::span<const HeadPoint> points, const PersonFrame& frame) {
    const HeadShape head = person_head_shape(frame);
    const float scale = 0.01f * frame.head_scale;
    for (const PersonFaceShape& shape : kFaceShapes) {
        MorphTarget target;
        target.name = shape.name;
        target.action_unit = shape.name;
        for (std::uint32_t v = 0; v < points.size(); ++v) {
            Vec3 offset(0);
            for (const UnitWeight& part : shape.units) {
                if (part.weight > 0) {
                    offset += part.weight * action_offset(action_unit(part.unit), points[v], head);
                }
            }
            if (scale * glm::length(offset) > kMinFaceShift) {
                target.vertices.push_back(v);
                target.positions.push_back(scale * offset);
            }
        }
        mesh.morphs.push_back(std::move(target));
    }
    generate_morph_normals(mesh);
}

std::vector<ClipData> make_person_face_clips(std::uint16_t first) {
    const auto target = [&](std::string_view name) {
        return static_cast<std::uint16_t>(first + face_shape_index(name));
    };
    return {
        make_person_talk(first),
        make_weight_clip(
            "blink", target("AU45"), {0, 1.0f, 1.09f, 1.13f, 1.33f, 3.7f}, {0, 0, 1, 1, 0, 0}),
        make_weight_clip("smile", target("AU12"), {0, 0.5f, 2.5f, 3.2f, 6}, {0, 0.8f, 0.8f, 0, 0})};
}

}  // namespace limn
