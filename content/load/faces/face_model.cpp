#include "content/load/faces/face_model.h"

#include "content/load/faces/face_import.h"
#include "content/load/files/atomic_file.h"
#include "content/load/obj/obj_lines.h"
#include "ecs/base/text.h"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <iterator>
#include <numeric>
#include <utility>

// Techniques: wrinkle.compression.face-model

namespace limn {
namespace {

constexpr std::array<float, 3> kBetween = {0.25f, 0.5f, 0.75f};  ///< values with in-betweens
constexpr float kMinBend = 1e-5f;  ///< smallest deviation from a line that is corrected [m]

struct ModelParser {
    ObjLines lines;
    const std::string& file;
    FaceModel model;
    bool has_transform = true;
    std::vector<std::uint32_t> slots{};  ///< of vertices in the parameter, from 1 on; 0: none

    Result<Vec3> vector(std::string_view what) {
        Vec3 v;
        for (int i = 0; i < 3; ++i) {
            v[i] = static_cast<float>(LIMN_TRY(lines.number(what)));
        }
        return v;
    }
    Status expect(std::string_view word) {
        const std::string_view found = lines.word();
        if (found != word) {
            return fail("{}: found {}, expected \"{}\"", lines.position(), found_word(found), word);
        }
        return Done{};
    }
    Status begin_parameter() {
        const std::string name(lines.word());
        if (name.empty()) {
            return fail("{}: found no name, expected that of a parameter", lines.position());
        }
        if (std::ranges::find(model.parameters, name, &FaceParameter::name)
            != model.parameters.end()) {
            return fail("{}: found a second parameter {}", lines.position(), name);
        }
        model.parameters.emplace_back().name = name;
        slots.assign(model.mesh.positions.size(), 0);
        has_transform = false;
        return Done{};
    }
    Status read_transform(std::string_view kind) {
        FaceParameter& parameter = model.parameters.back();
        if (has_transform) {
            return fail(
                "{}: found a second transform of {}, expected one", lines.position(),
                parameter.name);
        }
        parameter.vector = LIMN_TRY(vector("three numbers"));
        if (kind == "rotate") {
            parameter.transform = FaceTransform::Rotate;
            const float length = glm::length(parameter.vector);
            if (!(length > 0)) {
                return fail("{}: found the axis 0 0 0, expected a direction", lines.position());
            }
            parameter.vector /= length;
            LIMN_TRY(expect("by"));
            parameter.angle = radians(static_cast<float>(LIMN_TRY(lines.number("an angle"))));
        } else {
            parameter.transform = kind == "scale" ? FaceTransform::Scale : FaceTransform::Translate;
        }
        if (kind != "translate") {
            LIMN_TRY(expect("about"));
            parameter.pivot = LIMN_TRY(vector("a point"));
        }
        has_transform = true;
        return Done{};
    }
    /// Of several weights of a vertex, the largest counts.
    void add_weight(std::uint32_t vertex, float weight) {
        FaceParameter& parameter = model.parameters.back();
        std::uint32_t& slot = slots[vertex];
        if (slot == 0) {
            parameter.vertices.push_back(vertex);
            parameter.weights.push_back(weight);
            slot = static_cast<std::uint32_t>(parameter.vertices.size());
        } else {
            float& known = parameter.weights[slot - 1];
            known = std::max(known, weight);
        }
    }
    Status read_vertex() {
        const double number = LIMN_TRY(lines.number("the number of a vertex"));
        const auto count = static_cast<double>(model.mesh.positions.size());
        if (!(number >= 1 && number <= count && number == std::floor(number))) {
            return fail("{}: found vertex {}, expected 1 .. {}", lines.position(), number, count);
        }
        const double weight = LIMN_TRY(lines.number("a weight"));
        if (!(weight >= 0 && weight <= 1)) {
            return fail("{}: found the weight {}, expected 0 .. 1", lines.position(), weight);
        }
        if (weight > 0) {
            add_weight(static_cast<std::uint32_t>(number) - 1, static_cast<float>(weight));
        }
        return Done{};
    }
    Status read_ball() {
        const Vec3 center = LIMN_TRY(vector("a center"));
        const auto radius = static_cast<float>(LIMN_TRY(lines.number("a radius")));
        if (!(radius > 0)) {
            return fail("{}: found the radius {}, expected > 0", lines.position(), radius);
        }
        for (std::uint32_t v = 0; v < model.mesh.positions.size(); ++v) {
            const float far = glm::distance(model.mesh.positions[v], center) / radius;
            if (far < 1) {
                add_weight(v, 1 - glm::smoothstep(0.0f, 1.0f, far));
            }
        }
        return Done{};
    }
    Status read_line(std::string_view word) {
        if (word == "mesh") {
            lines.rest();
            return Done{};
        }
        if (word == "unit") {
            model.unit = static_cast<float>(LIMN_TRY(lines.number("meters")));
            if (!(model.unit > 0)) {
                return fail("{}: found unit {}, expected > 0", lines.position(), model.unit);
            }
            return Done{};
        }
        if (word == "parameter") {
            LIMN_TRY(check_transform());
            return begin_parameter();
        }
        const bool transform = word == "rotate" || word == "translate" || word == "scale";
        if (!transform && word != "vertex" && word != "ball") {
            return fail(
                "{}: found {}, expected mesh, unit, parameter, rotate, translate, scale, vertex or "
                "ball",
                lines.position(), found_word(word));
        }
        if (model.parameters.empty()) {
            return fail("{}: found {} before any parameter", lines.position(), found_word(word));
        }
        return transform ? read_transform(word) : word == "vertex" ? read_vertex() : read_ball();
    }
    Status check_transform() {
        if (!has_transform) {
            return fail(
                "{}: found no rotate, translate or scale of parameter {}", lines.position(),
                model.parameters.back().name);
        }
        return Done{};
    }
};

Vec3 moved(const FaceParameter& parameter, const Vec3& p, float amount) {
    switch (parameter.transform) {
    case FaceTransform::Translate:
        return p + amount * parameter.vector;
    case FaceTransform::Rotate:
        return parameter.pivot
               + glm::angleAxis(amount * parameter.angle, parameter.vector) * (p - parameter.pivot);
    case FaceTransform::Scale:
        break;
    }
    return parameter.pivot + (1.0f + amount * (parameter.vector - 1.0f)) * (p - parameter.pivot);
}

/// Offsets of all vertices with one or two parameters at these values.
std::vector<Vec3>
offsets_at(const FaceModel& model, const std::vector<std::pair<std::size_t, float>>& values) {
    std::vector<float> p(model.parameters.size(), 0.0f);
    for (const auto& [parameter, value] : values) {
        p[parameter] = value;
    }
    std::vector<Vec3> offsets = apply_face_model(model, p);
    for (std::size_t v = 0; v < offsets.size(); ++v) {
        offsets[v] -= model.mesh.positions[v];
    }
    return offsets;
}

bool is_bent(const std::vector<Vec3>& offsets, float unit) {
    return std::ranges::any_of(
        offsets, [&](const Vec3& offset) { return glm::length(offset) * unit > kMinBend; });
}

struct DrivenShape {
    FaceShape shape;
    std::vector<ShapeDriver> drivers;
};

/// The name, made longer where another shape has it: parameters come first, and keep theirs.
std::string unused_name(std::string name, const std::vector<DrivenShape>& shapes) {
    const auto is_taken = [&](const DrivenShape& other) { return other.shape.name == name; };
    while (std::ranges::any_of(shapes, is_taken)) {
        name += "_corrected";
    }
    return name;
}

/// Tents at kBetween that bend the line to the full rotation through the arc at those values.
void add_in_betweens(
    const FaceModel& model, std::size_t parameter, const std::vector<Vec3>& full,
    std::vector<DrivenShape>& shapes) {
    const auto tent = [](float value, float peak) {
        return std::min(value / peak, (1 - value) / (1 - peak));
    };
    Mat3 tents;  // column: tent, row: value
    std::array<std::vector<Vec3>, kBetween.size()> off;
    for (std::size_t i = 0; i < kBetween.size(); ++i) {
        off[i] = offsets_at(model, {{parameter, kBetween[i]}});
        for (std::size_t v = 0; v < full.size(); ++v) {
            off[i][v] -= kBetween[i] * full[v];
        }
        for (std::size_t k = 0; k < kBetween.size(); ++k) {
            tents[static_cast<int>(k)][static_cast<int>(i)] = tent(kBetween[i], kBetween[k]);
        }
    }
    const Mat3 solved = glm::inverse(tents);
    for (std::size_t k = 0; k < kBetween.size(); ++k) {
        std::vector<Vec3> offsets(full.size(), Vec3(0));
        for (std::size_t i = 0; i < kBetween.size(); ++i) {
            const float share = solved[static_cast<int>(i)][static_cast<int>(k)];
            for (std::size_t v = 0; v < full.size(); ++v) {
                offsets[v] += share * off[i][v];
            }
        }
        if (is_bent(offsets, model.unit)) {
            shapes.push_back(
                {{unused_name(
                      fmt::format(
                          "{}_{}", model.parameters[parameter].name,
                          static_cast<int>(100 * kBetween[k])),
                      shapes),
                  "", std::move(offsets)},
                 {{static_cast<std::uint16_t>(parameter), kBetween[k]}}});
        }
    }
}

}  // namespace

Result<FaceModel> parse_face_model(std::string_view text, const std::string& file, ObjFile mesh) {
    ModelParser parser = {.lines = ObjLines(text, file), .file = file, .model = {}};
    parser.model.mesh = std::move(mesh);
    while (parser.lines.next()) {
        const std::string_view word = parser.lines.word();
        if (word.empty()) {
            continue;
        }
        LIMN_TRY(parser.read_line(word));
        if (parser.lines.has_word()) {
            return fail(
                "{}: found {}, expected the end of the line", parser.lines.position(),
                found_word(parser.lines.word()));
        }
    }
    LIMN_TRY(parser.check_transform());
    if (parser.model.parameters.empty()) {
        return fail("{}: found no parameter, expected some", file);
    }
    return std::move(parser.model);
}

Result<FaceModel> load_face_model(const std::string& path) {
    const std::vector<std::byte> bytes = LIMN_TRY(read_file(path));
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    ObjLines lines(text, path);
    std::string mesh;
    while (mesh.empty() && lines.next()) {
        mesh = lines.word() == "mesh" ? std::string(lines.rest()) : "";
    }
    if (mesh.empty()) {
        return fail("{}: found no mesh, expected \"mesh FILE.obj\"", path);
    }
    const std::filesystem::path beside = std::filesystem::path(path).parent_path() / mesh;
    return parse_face_model(text, path, LIMN_TRY(load_intact_obj(beside.string())));
}

std::vector<Vec3> apply_face_model(const FaceModel& model, std::span<const float> p) {
    std::vector<Vec3> positions = model.mesh.positions;
    for (std::size_t i = 0; i < std::min(model.parameters.size(), p.size()); ++i) {
        const FaceParameter& parameter = model.parameters[i];
        for (std::size_t k = 0; p[i] != 0 && k < parameter.vertices.size(); ++k) {
            Vec3& at = positions[parameter.vertices[k]];
            at = moved(parameter, at, p[i] * parameter.weights[k]);
        }
    }
    return positions;
}

GltfScene make_face_model_scene(const std::string& name, const FaceModel& model) {
    std::vector<DrivenShape> shapes;
    for (std::size_t i = 0; i < model.parameters.size(); ++i) {
        shapes.push_back({{model.parameters[i].name, "", offsets_at(model, {{i, 1}})}, {}});
    }
    for (std::size_t i = 0; i < model.parameters.size(); ++i) {
        if (model.parameters[i].transform == FaceTransform::Rotate) {
            const std::vector<Vec3> full = shapes[i].shape.offsets;
            add_in_betweens(model, i, full, shapes);
        }
        for (std::size_t k = 0; k < i; ++k) {
            std::vector<Vec3> offsets = offsets_at(model, {{k, 1}, {i, 1}});
            for (std::size_t v = 0; v < offsets.size(); ++v) {
                offsets[v] -= shapes[i].shape.offsets[v] + shapes[k].shape.offsets[v];
            }
            if (is_bent(offsets, model.unit)) {
                shapes.push_back(
                    {{unused_name(
                          model.parameters[k].name + "_" + model.parameters[i].name, shapes),
                      "", std::move(offsets)},
                     {{static_cast<std::uint16_t>(k), 1}, {static_cast<std::uint16_t>(i), 1}}});
            }
        }
    }
    FacePart part;
    part.material = skin_material();
    part.faces.resize(model.mesh.faces.size());
    std::iota(part.faces.begin(), part.faces.end(), 0u);
    std::vector<FaceShape> plain;
    for (const DrivenShape& each : shapes) {
        plain.push_back(each.shape);
    }
    GltfScene scene =
        make_face_scene(name, model.mesh, model.unit, {&part, 1}, plain, model.mesh.positions);
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        scene.meshes[0].morphs[i].drivers = shapes[i].drivers;
    }
    return scene;
}

}  // namespace limn
