#include "bench/micro/svg_plot.h"
#include "bench/oracles/marked_head.h"
#include "bench/oracles/skin_readback.h"
#include "bench/quality/quality.h"
#include "content/make/head/head.h"
#include "content/make/head/head_expressions.h"
#include "content/speech/coarticulation.h"
#include "content/speech/mouth.h"
#include "content/speech/resample.h"
#include "content/speech/speech_library.h"
#include "content/speech/speech_units.h"
#include "content/speech/utterance.h"
#include "ecs/base/rng.h"
#include "ecs/base/text.h"
#include "ecs/components/animation.h"
#include "ecs/components/deformers.h"
#include "ecs/components/surface.h"
#include "ecs/components/surface_binding.h"
#include "ecs/components/transform.h"
#include "ecs/world.h"
#include "systems/animation/deformer_kernels.h"
#include "systems/animation/deformer_system.h"
#include "systems/animation/patch_kernels.h"
#include "systems/animation/skin_kernels.h"
#include "systems/animation/surface_patches.h"
#include "systems/faces/skin_strain.h"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

// Faces: what moves them and what measures their skin. Compares speech with sums in double
// precision and an exhaustive search, deformers on CPU and GPU with their definitions, a head bound
// to its markers with its own shapes, strain with the polar decomposition.

namespace limn::faces_quality {
namespace {

using glm::dvec3;

// ---- speech -------------------------------------------------------------------------------------

/// Motion of the mouth during a sentence, per axis.
std::string mouth_plot(const SpeechTrack& track, const MouthTrack& mouth) {
    struct Axis {
        MouthAxis axis;
        const char* name;
        const char* color;
    };
    constexpr Axis kAxes[] = {
        {MouthAxis::Jaw, "jaw", "#2a6fbb"},
        {MouthAxis::Width, "width", "#c8553d"},
        {MouthAxis::Protrusion, "protrusion", "#2e8b6f"},
        {MouthAxis::LipsShut, "lips shut", "#d08a1d"}};
    constexpr double kLeft = 20;
    constexpr double kWidth = 860;
    constexpr double kZero = 150;
    constexpr double kUnit = 110;
    const double per_second = kWidth / static_cast<double>(track.duration());
    bench::Svg svg;
    for (const SpeechSegment& segment : track.segments) {
        const double x = kLeft + per_second * static_cast<double>(segment.start);
        svg.line(x, 30, x, 272, "#eeeeea");
        svg.text(x + 2, 284, phonemes()[segment.sound.phoneme].name, bench::kFaint, "start", 8);
    }
    svg.line(kLeft, kZero, kLeft + kWidth, kZero, "#aaa");
    double label = kLeft;
    for (const Axis& axis : kAxes) {
        std::vector<std::array<double, 2>> points;
        for (float time = 0; time < track.duration(); time += 0.01f) {
            const float value = mouth_at(mouth, time)[static_cast<std::size_t>(axis.axis)];
            points.push_back(
                {kLeft + per_second * static_cast<double>(time),
                 kZero - kUnit * static_cast<double>(value)});
        }
        svg.curve(points, axis.color, 1.6);
        svg.text(label, 18, axis.name, axis.color);
        label += 90;
    }
    return "<h3>The mouth of a sentence</h3>\n" + svg.done(900, 296);
}

void measure_coarticulation(QualityReport& report) {
    const SpeechTrack track =
        spell_utterance("The blue moon paints a smooth boat, five thin spoons and a map.").track;
    const MouthTrack mouth = make_mouth_track(track);
    double error = 0;
    double outside = 0;
    for (const std::vector<DominanceTarget>& axis : mouth) {
        for (float time = 0; time < track.duration(); time += 0.004f) {
            double sum = 0;
            double total = 0;
            double low = 1e9;
            double high = -1e9;
            for (const DominanceTarget& t : axis) {
                const double theta = time < t.center ? t.before : t.after;
                const double distance = std::abs(double{time} - double{t.center});
                const double weight =
                    double{t.strength} * std::exp(-theta * std::pow(distance, double{t.power}));
                sum += weight * double{t.target};
                total += weight;
                low = std::min(low, double{t.target});
                high = std::max(high, double{t.target});
            }
            const double found = blend_targets(axis, time);
            if (total > 1e-6) {
                error = std::max(error, std::abs(found - sum / total));
                outside = std::max({outside, low - found, found - high});
            }
        }
    }
    report.at_most("coarticulation: mouth against sums in double precision", error, 1e-5);
    report.at_most("coarticulation: beyond the targets", outside, 1e-6);
    report.html += mouth_plot(track, mouth);
}

/// Whether a unit contains the sounds of the target from segment `at` on.
bool fits(
    const SpeechTrack& target, std::size_t at, const SpeechUnit& unit,
    std::span<const SpeechRecording> recordings) {
    if (at + unit.count > target.segments.size()) {
        return false;
    }
    for (std::size_t i = 0; i < unit.count; ++i) {
        if (target.segments[at + i].sound.phoneme
            != recordings[unit.recording].track.segments[unit.first + i].sound.phoneme) {
            return false;
        }
    }
    return true;
}

constexpr std::size_t kImpossible = 1000;

/// The fewest units that cover the target from half sound `half` on, by exhaustive search.
std::size_t fewest_units(
    const SpeechTrack& target, std::span<const SpeechUnit> units,
    std::span<const SpeechRecording> recordings, std::size_t half) {
    if (half >= 2 * target.segments.size()) {
        return 0;
    }
    std::size_t fewest = target.segments[half / 2].sound.phoneme == 0
                             ? fewest_units(target, units, recordings, half + 1)
                             : kImpossible;
    for (const SpeechUnit& unit : units) {
        const bool is_diphone = unit.kind == UnitKind::Diphone;
        if ((half % 2 == 1) == is_diphone && fits(target, half / 2, unit, recordings)) {
            const std::size_t next = half + (is_diphone ? 2 : 2 * std::size_t{unit.count});
            fewest = std::min(fewest, 1 + fewest_units(target, units, recordings, next));
        }
    }
    return fewest;
}

void measure_selection(QualityReport& report) {
    std::vector<SpeechRecording> recordings;
    for (const char* const text : {"no time", "time is", "is no", "mine"}) {
        recordings.push_back(record_mouth(text, spell_utterance(text).track, 60));
    }
    const std::vector<SpeechUnit> units = generate_units(recordings);
    std::size_t more = 0;
    std::size_t covered = 0;
    for (const char* const text :
         {"no time is no time", "mine is no", "time mine", "is is is", "no mine"}) {
        const SpeechTrack target = spell_utterance(text).track;
        const std::size_t fewest = fewest_units(target, units, recordings, 0);
        const auto selected = select_units(target, units, recordings, 0);
        if (selected.ok() != (fewest < kImpossible)) {
            ++more;
        } else if (selected.ok()) {
            ++covered;
            more += selected->size() - fewest;
        }
    }
    report.at_most(
        "unit selection: units in excess of an exhaustive search", static_cast<double>(more), 0);
    report.at_least("unit selection: sentences that can be said", static_cast<double>(covered), 3);
}

// ---- deformers ----------------------------------------------------------------------------------

Deformers face_controls() {
    Deformers controls;
    for (const float side : {-1.0f, 1.0f}) {
        controls.muscles.push_back(
            {.attachment = {side * 0.058f, 0.004f, 0.04f},
             .insertion = {side * 0.026f, -0.036f, 0.092f},
             .angle = 0.6f,
             .full = 0.066f,
             .reach = 0.1f,
             .contraction = 0.22f});
    }
    controls.sphincters.push_back(
        {.center = {0, -0.036f, 0.09f},
         .right = {0.042f, 0, 0},
         .up = {0, 0.024f, 0},
         .depth = 0.04f,
         .contraction = 0.3f});
    Lattice box = {
        .origin = {-0.034f, -0.024f, 0.06f},
        .u = {0.068f, 0, 0},
        .v = {0, 0.075f, 0},
        .w = {0, 0, 0.09f},
        .offsets = std::vector<Vec3>(kLatticePoints, Vec3{0, 0, 0})};
    for (const std::size_t point : {37, 38, 41, 42, 53, 54}) {
        box.offsets[point] = {0, -0.004f, 0.02f};
    }
    controls.lattices.push_back(std::move(box));
    controls.tugs.push_back(
        {.at = {0.035f, -0.02f, 0.08f}, .offset = {0.004f, 0.012f, 0.003f}, .radius = 0.04f});
    return controls;
}

double squared_cosine(double quarters) {
    const double cosine = std::cos(0.5 * glm::pi<double>() * quarters);
    return cosine * cosine;
}

/// Moves a point by the controls' definitions (face.waters-muscle, face.ffd, face.pull).
dvec3 exact_point(const Deformers& controls, dvec3 p) {
    dvec3 pull(0);
    double farthest = 0;
    for (const LinearMuscle& m : controls.muscles) {
        const dvec3 bone = m.attachment;
        const dvec3 axis = dvec3(m.insertion) - bone;
        const dvec3 arm = p - bone;
        const double distance = glm::length(arm);
        const double angle =
            std::acos(std::clamp(glm::dot(arm, axis) / (distance * glm::length(axis)), -1.0, 1.0));
        if (distance == 0 || distance >= double{m.reach} || angle >= double{m.angle}) {
            continue;
        }
        const double rise =
            std::sin(0.5 * glm::pi<double>() * std::min(distance / double{m.full}, 1.0));
        const double beyond =
            std::max((distance - double{m.full}) / (double{m.reach} - double{m.full}), 0.0);
        pull -= double{m.contraction} * glm::length(axis) * rise * squared_cosine(beyond)
                * squared_cosine(angle / double{m.angle}) * arm / distance;
        farthest = std::max(farthest, distance);
    }
    for (const SphincterMuscle& s : controls.sphincters) {
        const dvec3 to_center = dvec3(s.center) - p;
        const dvec3 right = s.right;
        const dvec3 up =
            dvec3(s.up) - right * (glm::dot(dvec3(s.up), right) / glm::dot(right, right));
        const dvec3 deep = glm::normalize(glm::cross(right, up));
        const dvec3 q = {
            glm::dot(to_center, right) / glm::dot(right, right),
            glm::dot(to_center, up) / glm::dot(up, up),
            glm::dot(to_center, deep) / double{s.depth}};
        if (glm::length(q) < 1) {
            const dvec3 inward = to_center - glm::dot(to_center, deep) * deep;
            pull += double{s.contraction} * (1 - glm::length(q)) * inward;
            farthest = std::max(farthest, glm::length(inward));
        }
    }
    const double length = glm::length(pull);
    p += length > farthest ? farthest / length * pull : pull;
    for (const Lattice& box : controls.lattices) {
        const dvec3 q = glm::inverse(glm::dmat3(dvec3(box.u), dvec3(box.v), dvec3(box.w)))
                        * (p - dvec3(box.origin));
        if (glm::any(glm::lessThan(q, dvec3(0))) || glm::any(glm::greaterThan(q, dvec3(1)))) {
            continue;
        }
        // De Casteljau, axis by axis.
        std::array<dvec3, kLatticePoints> points;
        std::copy(box.offsets.begin(), box.offsets.end(), points.begin());
        std::size_t count = kLatticePoints;
        for (int axis = 0; axis < 3; ++axis) {
            count /= 4;
            for (std::size_t i = 0; i < count; ++i) {
                std::array<dvec3, 4> row = {
                    points[4 * i], points[4 * i + 1], points[4 * i + 2], points[4 * i + 3]};
                for (std::size_t left = 3; left > 0; --left) {
                    for (std::size_t k = 0; k < left; ++k) {
                        row[k] = glm::mix(row[k], row[k + 1], q[axis]);
                    }
                }
                points[i] = row[0];
            }
        }
        p += points[0];
    }
    for (const Tug& tug : controls.tugs) {
        const double r = glm::distance(p, dvec3(tug.at)) / double{tug.radius};
        p += r < 1 ? std::pow(1 - r * r, 3) * dvec3(tug.offset) : dvec3(0);
    }
    return p;
}

Status measure_deformers(gpu::Device& device, QualityReport& report) {
    World world;
    auto& assets = world.insert_resource(Assets{});
    assets.meshes.push_back(make_head({}));
    assets.materials.emplace_back();
    const MeshData& head = assets.meshes[0];
    const Deformers controls = face_controls();
    const Entity face = world.create(
        Transform{}, WorldTransform{}, PreviousWorldTransform{},
        MeshInstance{MeshId{0}, MaterialId{0}}, controls);
    world.run(add_deformer_states);
    world.run(update_deformers);
    const std::vector<Vec4> packed = world.get<DeformerState>(face).now;

    std::vector<Vec3> moved = head.positions;
    deform_points(packed, moved);
    std::vector<Vec3> one_by_one = head.positions;
    deform_points_scalar(packed, one_by_one);
    auto gpu = LIMN_TRY(oracle::SkinReadback::create(device));
    const oracle::SkinReadbackVertices drawn = gpu.run(world, std::array{face})[0];
    if (drawn.positions.size() != moved.size()) {
        return fail("faces: found no deformed head on the GPU, expected one");
    }
    double error = 0;
    double gpu_error = 0;
    double farthest = 0;
    std::size_t differ = 0;
    for (std::size_t v = 0; v < moved.size(); ++v) {
        const dvec3 exact = exact_point(controls, head.positions[v]);
        error = std::max(error, glm::distance(dvec3(moved[v]), exact));
        gpu_error =
            std::max(gpu_error, static_cast<double>(glm::distance(drawn.positions[v], moved[v])));
        farthest =
            std::max(farthest, static_cast<double>(glm::distance(moved[v], head.positions[v])));
        differ += moved[v] != one_by_one[v] ? 1 : 0;
    }
    report.at_least(
        "deformers: farthest that a vertex of the head moves", 1000 * farthest, 5, "mm");
    report.at_most("deformers: CPU against double precision", 1e6 * error, 0.5, "um");
    report.at_most("deformers: GPU against CPU", 1e6 * gpu_error, 1, "um");
    report.at_most("deformers: vertices that differ with SIMD", static_cast<double>(differ), 0);
    return Done{};
}

// ---- markers ------------------------------------------------------------------------------------

struct MarkedExpression {
    const char* name;
    std::array<std::string_view, 4> units;  ///< at weight 1; empty ones at the end
    double max_mm;                          ///< RMS distance
    double max_relative;                    ///< to the RMS motion
    double max_folded;                      ///< edges where sides of a fold touch
};

constexpr MarkedExpression kMarked[] = {
    {"jaw drops", {"AU26"}, 0.45, 0.12, 0},
    {"mouth opens wide", {"AU27", "AU25"}, 1.1, 0.11, 0},
    {"smile", {"AU12_L", "AU12_R", "AU6_L", "AU6_R"}, 0.5, 0.23, 24},
    {"blink", {"AU45_L", "AU45_R"}, 0.22, 0.34, 40},
    {"pucker", {"AU18"}, 0.33, 0.18, 34},
    {"brows rise", {"AU1_L", "AU1_R", "AU2_L", "AU2_R"}, 0.33, 0.36, 24},
    {"frown", {"AU4_L", "AU4_R"}, 0.16, 0.29, 20},
    {"nose wrinkles", {"AU9_L", "AU9_R"}, 0.22, 0.41, 16},
};

/// `mesh` in an expression of the head's shapes.
std::vector<Vec3> shape_of(const MeshData& mesh, const MarkedExpression& expression) {
    std::vector<float> weights(mesh.morphs.size(), 0.0f);
    for (const std::string_view unit : expression.units) {
        if (!unit.empty()) {
            weights[expression_index(unit)] = 1.0f;
        }
    }
    std::vector<Vec3> positions = mesh.positions;
    add_morphs(mesh.morphs, weights, {positions, {}, {}});
    return positions;
}

double rms_mm(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    double sum = 0;
    for (std::size_t v = 0; v < a.size(); ++v) {
        const dvec3 difference = dvec3(a[v]) - dvec3(b[v]);
        sum += glm::dot(difference, difference);
    }
    return 1000 * std::sqrt(sum / static_cast<double>(a.size()));
}

/// What the surface does at the edges of its patches.
struct EdgesOfPatches {
    double crease = 0;  ///< largest angle between the tangent planes on both sides [degrees]
    int folded = 0;     ///< edges of triangles that face away from a normal at an end: not counted
};

EdgesOfPatches edges_of_patches(
    const std::vector<Vec3>& positions, const std::vector<std::uint32_t>& corners,
    const std::vector<Vec4>& patches) {
    std::vector<Vec3> areas;
    std::vector<Vec3> normals(positions.size(), Vec3(0));  // as the patches have them
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec3& a = positions[corners[i / 3 * 3]];
        areas.push_back(glm::cross(
            positions[corners[i / 3 * 3 + 1]] - a, positions[corners[i / 3 * 3 + 2]] - a));
        normals[corners[i]] = Vec3(patches[i / 3 * kPatchTexels + kPatchNormals + i % 3]);
    }
    const auto next = [](std::size_t i) { return i % 3 == 2 ? i - 2 : i + 1; };
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> edges;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        edges[{corners[i], corners[next(i)]}] = i;
    }
    const auto plane = [&](std::size_t i, float share) {
        Vec3 weights(0);
        weights[static_cast<int>(i % 3)] = 1.0f - share;
        weights[static_cast<int>(next(i) % 3)] = share;
        const auto patch = std::span(patches).subspan(i / 3 * kPatchTexels, kPatchTexels);
        const PatchPoint at = evaluate_patch(patch, weights.x, weights.y);
        return glm::normalize(glm::cross(dvec3(at.by_u), dvec3(at.by_v)));
    };
    EdgesOfPatches found;
    for (const auto& [ends, i] : edges) {
        const auto other = edges.find({ends.second, ends.first});
        if (other == edges.end() || ends.first > ends.second) {
            continue;
        }
        bool folds = false;
        for (const std::size_t face : {i, other->second}) {
            for (const std::uint32_t end : {ends.first, ends.second}) {
                folds = folds || !(glm::dot(areas[face], normals[end]) > 0.0f);
            }
        }
        found.folded += folds ? 1 : 0;
        for (int k = 0; k <= 16 && !folds; ++k) {
            const float share = static_cast<float>(k) / 16;
            const dvec3 a = plane(i, share);
            const dvec3 b = plane(other->second, 1.0f - share);
            found.crease = std::max(
                found.crease,
                glm::degrees(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b))));
        }
    }
    return found;
}

Status measure_markers(QualityReport& report) {
    const MeshData head = make_head({});
    const MeshData markers = make_head({.part = HeadPartKind::Markers});
    const SurfaceBindingState state = oracle::bind_to_markers(head, markers);
    if (state.anchors == nullptr) {
        return fail("faces: the head is not bound to its markers");
    }
    std::vector<Vec4> patches;
    const auto moved_by = [&](const std::vector<Vec3>& shape) {
        make_patches(shape, state.corners, patches);
        std::vector<Vec3> positions = head.positions;
        move_by_patches(surface_shape(&state, patches), positions);
        return positions;
    };
    double at_rest = 0;
    const std::vector<Vec3> rest = moved_by(markers.positions);
    for (std::size_t v = 0; v < rest.size(); ++v) {
        at_rest = std::max(at_rest, static_cast<double>(glm::distance(rest[v], head.positions[v])));
    }
    report.inform(
        "markers: vertices of the surface", static_cast<double>(markers.positions.size()));
    report.inform(
        "markers: vertices of the head that they do not move",
        static_cast<double>(head.positions.size() - state.order->size()));
    report.at_most("markers: farthest vertex at rest", at_rest, 1e-6, "m");
    for (const MarkedExpression& expression : kMarked) {
        const std::vector<Vec3> truth = shape_of(head, expression);
        const double error = rms_mm(moved_by(shape_of(markers, expression)), truth);
        const double motion = rms_mm(truth, head.positions);
        report.at_most(
            fmt::format("markers: {}, head beside its own shapes, RMS", expression.name), error,
            expression.max_mm, "mm");
        report.at_most(
            fmt::format("markers: {}, that relative to the motion", expression.name),
            error / motion, expression.max_relative);
        const std::vector<Vec3> shape = shape_of(markers, expression);
        make_patches(shape, state.corners, patches);
        const EdgesOfPatches edges = edges_of_patches(shape, state.corners, patches);
        report.at_most(
            fmt::format("markers: {}, crease between patches", expression.name), edges.crease, 0.1,
            "degrees");
        report.at_most(
            fmt::format("markers: {}, edges where sides of a fold touch", expression.name),
            static_cast<double>(edges.folded), expression.max_folded);
    }
    return Done{};
}

// ---- strain -------------------------------------------------------------------------------------

using Triangle = std::array<dvec3, 3>;

/// sqrt(F^T F) - I as (uu, vv, uv) by its eigenvectors; axes as in SkinTriangles.
dvec3 exact_strain(const Triangle& rest, const Triangle& now) {
    const dvec3 e1 = rest[1] - rest[0];
    const dvec3 e2 = rest[2] - rest[0];
    const dvec3 normal = glm::normalize(glm::cross(e1, e2));
    const dvec3 u = glm::normalize(glm::cross(dvec3(0, 1, 0), normal));
    const dvec3 v = glm::cross(normal, u);
    const glm::dmat2 at_rest = {glm::dot(u, e1), glm::dot(v, e1), glm::dot(u, e2), glm::dot(v, e2)};
    const dvec3 f1 = now[1] - now[0];
    const dvec3 f2 = now[2] - now[0];
    const glm::dmat2 products = {
        glm::dot(f1, f1), glm::dot(f1, f2), glm::dot(f1, f2), glm::dot(f2, f2)};
    const glm::dmat2 inverse = glm::inverse(at_rest);
    const glm::dmat2 tensor = glm::transpose(inverse) * products * inverse;
    const double mean = 0.5 * (tensor[0][0] + tensor[1][1]);
    const double half = 0.5 * (tensor[0][0] - tensor[1][1]);
    const double radius = std::hypot(half, tensor[0][1]);
    const double angle = 0.5 * std::atan2(tensor[0][1], half);  // of the longer axis
    const double longer = std::sqrt(mean + radius) - 1;
    const double shorter = std::sqrt(std::max(mean - radius, 0.0)) - 1;
    const double c = std::cos(angle);
    const double t = std::sin(angle);
    return {
        c * c * longer + t * t * shorter, t * t * longer + c * c * shorter,
        c * t * (longer - shorter)};
}

void measure_strain(QualityReport& report) {
    const std::vector<std::uint32_t> triangle = {0, 1, 2};
    Random random(9, 0, 0, 0);
    const auto point = [&] {
        return Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    };
    double error = 0;
    double rigid = 0;
    double greatest = 0;
    const auto of = [](const SkinStrain& strain) { return dvec3(strain.uu, strain.vv, strain.uv); };
    for (int i = 0; i < 2000; ++i) {
        const std::vector<Vec3> rest = {point(), point(), point()};
        const SkinTriangles skin = make_skin_triangles(rest, triangle, 0.05f);
        const float longest = std::max(
            {glm::distance(rest[0], rest[1]), glm::distance(rest[0], rest[2]),
             glm::distance(rest[1], rest[2])});
        const float twice_area = glm::length(glm::cross(rest[1] - rest[0], rest[2] - rest[0]));
        if (skin.area.empty() || twice_area < 0.25f * longest * longest) {
            continue;  // thin triangles lose precision
        }
        // Stretched along two perpendicular directions in its plane, then rotated as a whole.
        const dvec3 u = skin.u[0];
        const dvec3 v = skin.v[0];
        const double angle = random.uniform(0, 3);
        const dvec3 first = std::cos(angle) * u + std::sin(angle) * v;
        const dvec3 second = -std::sin(angle) * u + std::cos(angle) * v;
        const double along_first = random.uniform(0.5f, 1.6f);
        const double along_second = random.uniform(0.5f, 1.6f);
        const dvec3 axis = glm::normalize(dvec3(point()));
        const double turn = random.uniform(0, 3);
        const auto turned = [&](const dvec3& p) {
            return std::cos(turn) * p + std::sin(turn) * glm::cross(axis, p)
                   + (1 - std::cos(turn)) * glm::dot(axis, p) * axis;
        };
        std::vector<Vec3> stretched;
        std::vector<Vec3> moved;
        for (const Vec3& corner : rest) {
            const dvec3 p = dvec3(corner) - dvec3(rest[0]);
            moved.emplace_back(turned(p));
            stretched.emplace_back(turned(
                p + (along_first - 1) * glm::dot(p, first) * first
                + (along_second - 1) * glm::dot(p, second) * second));
        }
        std::vector<SkinStrain> strain(1);
        find_strain(skin, stretched, strain);
        const Triangle at_rest = {rest[0], rest[1], rest[2]};
        const dvec3 exact = exact_strain(at_rest, {stretched[0], stretched[1], stretched[2]});
        error = std::max(error, glm::distance(exact, of(strain[0])));
        find_strain(skin, moved, strain);
        rigid = std::max(rigid, glm::length(of(strain[0])));
        greatest = std::max(greatest, glm::length(exact));
    }
    report.inform(
        "strain: the largest of some hundred triangles, no thinner than 1 in 4", greatest);
    report.at_most("strain: against its eigenvectors in double precision", error, 1e-5);
    report.at_most("strain: of a triangle that only turns", rigid, 2e-5);
}

Status measure_faces(HeadlessRenderer& headless, QualityReport& report) {
    LIMN_TRY(measure_deformers(*headless.device, report));
    LIMN_TRY(measure_markers(report));
    measure_strain(report);
    return Done{};
}

Status measure_speech(HeadlessRenderer&, QualityReport& report) {
    measure_coarticulation(report);
    measure_selection(report);
    return Done{};
}

const RegisterQuality kRegistered("faces", "definitions in double precision", measure_faces);
const RegisterQuality kRegisteredSpeech(
    "speech", "sums in double precision; a search that tries all units", measure_speech);

}  // namespace
}  // namespace limn::faces_quality
