#include "content/load/faces/ict_facekit.h"

#include "content/load/obj/obj_file.h"
#include "ecs/base/text.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <filesystem>
#include <limits>
#include <map>
#include <utility>
#include <vector>

namespace limn {

namespace {

constexpr const char* kNeutral = "generic_neutral_mesh.obj";
constexpr float kScale = 0.01f;  // the files are in centimeters

// Vertices of the topology, in order: the face, the head behind it, the linings of mouth and eyes,
// gums, tongue, teeth, eyes and their surroundings.
constexpr std::uint32_t kFaceEnd = 9409;
constexpr std::uint32_t kHeadEnd = 11248;
constexpr std::size_t kVertices = 26719;

struct UnitOfShape {
    std::string_view shape;
    std::string_view unit;
};

/// Without the suffixes "_L" and "_R". After the descriptions of the units in Ekman and Friesen
/// 1978.
constexpr UnitOfShape kUnits[] = {
    {"browDown", "AU4"},         {"browInnerUp", "AU1"},     {"browOuterUp", "AU2"},
    {"cheekPuff", "AU34"},       {"cheekSquint", "AU6"},     {"eyeBlink", "AU45"},
    {"eyeLookDown", "AU64"},     {"eyeLookUp", "AU63"},      {"eyeSquint", "AU7"},
    {"eyeWide", "AU5"},          {"jawForward", "AU29"},     {"jawOpen", "AU27"},
    {"mouthClose", "AU8"},       {"mouthDimple", "AU14"},    {"mouthFrown", "AU15"},
    {"mouthFunnel", "AU22"},     {"mouthLowerDown", "AU16"}, {"mouthPress", "AU24"},
    {"mouthPucker", "AU18"},     {"mouthRollLower", "AU28"}, {"mouthRollUpper", "AU28"},
    {"mouthShrugLower", "AU17"}, {"mouthSmile", "AU12"},     {"mouthStretch", "AU20"},
    {"mouthUpperUp", "AU10"},    {"noseSneer", "AU9"},
};

/// Expressions whose side is a direction.
constexpr UnitOfShape kSidedUnits[] = {
    {"eyeLookIn_L", "AU62_L"},  {"eyeLookIn_R", "AU61_R"}, {"eyeLookOut_L", "AU61_L"},
    {"eyeLookOut_R", "AU62_R"}, {"jawLeft", "AU30_L"},     {"jawRight", "AU30_R"},
};

/// "mouthSmile" and "_L".
std::pair<std::string_view, std::string_view> split_shape_side(std::string_view name) {
    const bool has_side = name.ends_with("_L") || name.ends_with("_R");
    const std::size_t end = has_side ? name.size() - 2 : name.size();
    return {name.substr(0, end), name.substr(end)};
}

bool is_expression(const std::filesystem::path& path) {
    const std::string name = path.filename().string();
    return path.extension() == ".obj" && name != kNeutral && !name.starts_with("identity");
}

/// Paths of the expressions, by name.
Result<std::map<std::string, std::string>> find_expressions(const std::filesystem::path& folder) {
    std::map<std::string, std::string> found;
    std::error_code error;
    for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error)) {
        if (is_expression(entry->path())) {
            found.emplace(entry->path().stem().string(), entry->path().string());
        }
    }
    if (error) {
        return fail("{}: cannot be read: {}", folder.string(), error.message());
    }
    if (found.empty()) {
        return fail(
            "{}: found no expressions, expected files such as mouthSmile_L.obj beside {}",
            folder.string(), kNeutral);
    }
    return found;
}

Result<ObjFile> load_mesh(const std::string& path) {
    ObjFile obj = LIMN_TRY(load_intact_obj(path));
    if (obj.positions.size() != kVertices) {
        return fail(
            "{}: found {} vertices, expected the {} of ICT FaceKit", path, obj.positions.size(),
            kVertices);
    }
    return obj;
}

constexpr float kLimbus = 0.487f;      ///< of the radius of the ball
constexpr float kLidRadius = 2.2f;     ///< of the lids around the center of an eye [cm]
constexpr float kUpperLashes = 0.45f;  ///< distance from the lid at which lashes end [cm]
constexpr float kLowerLashes = 0.15f;

class IctImporter {
  public:
    explicit IctImporter(const ObjFile& neutral) : obj_(neutral) {
        find_eyes();
        for (std::uint32_t v = 0; v < kFaceEnd; ++v) {
            const Vec3& p = obj_.positions[v];
            if (glm::distance(p, eye_at(p).center) < kLidRadius) {
                lids_.push_back(v);
            }
        }
        reference_.assign(kVertices, Vec3(std::numeric_limits<float>::quiet_NaN()));
        std::copy_n(obj_.positions.begin(), kFaceEnd, reference_.begin());
    }

    [[nodiscard]] GltfScene make_scene(std::span<const FaceShape> shapes) const {
        std::map<std::string, FacePart> parts;
        const auto tint = [this](std::uint32_t p) { return skin_tint(reference_[p]); };
        const auto iris = [this](std::uint32_t p) {
            return iris_color(eye_at(obj_.positions[p]), obj_.positions[p]);
        };
        parts["skin"] = {.material = skin_material(), .faces = {}, .color = tint, .is_skin = true};
        parts["mucosa"] = {.material = mucosa_material(), .faces = {}};
        parts["teeth"] = {.material = teeth_material(), .faces = {}};
        parts["sclera"] = {.material = sclera_material(), .faces = {}};
        parts["iris"] = {.material = iris_material(), .faces = {}, .color = iris};
        parts["cornea"] = {.material = cornea_material(), .faces = {}};
        const auto lash = [this](std::uint32_t p) { return Vec4(1, 1, 1, lash_opacity(p)); };
        parts["lashes"] = {.material = lash_material(), .faces = {}, .color = lash};
        for (std::uint32_t f = 0; f < obj_.faces.size(); ++f) {
            const auto part = parts.find(part_of(obj_.faces[f]));
            if (part != parts.end()) {
                part->second.faces.push_back(f);
            }
        }
        std::vector<FacePart> list;
        for (const char* const name :
             {"skin", "mucosa", "teeth", "sclera", "iris", "cornea", "lashes"}) {
            list.push_back(std::move(parts[name]));
        }
        return make_face_scene("face", obj_, kScale, list, shapes, reference_);
    }

  private:
    [[nodiscard]] std::span<const ObjCorner> corners_of(const ObjFace& face) const {
        return std::span(obj_.corners).subspan(face.first, face.count);
    }
    [[nodiscard]] const Vec3& position_of(const ObjCorner& corner) const {
        return obj_.positions[corner.position];
    }
    /// Opaque at the border of the lid, transparent at the tip: the cards have no images of hairs.
    [[nodiscard]] float lash_opacity(std::uint32_t position) const {
        float nearest = std::numeric_limits<float>::infinity();
        for (const std::uint32_t lid : lids_) {
            nearest =
                std::min(nearest, glm::distance(obj_.positions[position], obj_.positions[lid]));
        }
        const Vec3& p = obj_.positions[position];
        const float length = p.y > eye_at(p).center.y ? kUpperLashes : kLowerLashes;
        return 1 - glm::smoothstep(0.0f, length, nearest);
    }

    [[nodiscard]] const EyeBall& eye_at(const Vec3& p) const { return eyes_[p.x < 0 ? 1 : 0]; }

    void find_eyes() {
        std::array<std::vector<Vec3>, 2> balls;
        for (const ObjFace& face : obj_.faces) {
            if (obj_.materials[face.material].starts_with("M_Sclera")) {
                for (const ObjCorner& corner : corners_of(face)) {
                    const Vec3& p = position_of(corner);
                    balls[p.x < 0 ? 1 : 0].push_back(p);
                }
            }
        }
        for (std::size_t side = 0; side < 2; ++side) {
            eyes_[side] = find_eye_ball(balls[side], kLimbus);
        }
    }

    /// "" for faces that are skipped.
    [[nodiscard]] std::string part_of(const ObjFace& face) const {
        const std::string& material = obj_.materials[face.material];
        const std::span<const ObjCorner> corners = corners_of(face);
        const auto all = [&](const auto& predicate) {
            return std::all_of(corners.begin(), corners.end(), predicate);
        };
        if (material == "M_Face" || material == "M_BackHead") {
            return all([](const ObjCorner& c) { return c.position < kHeadEnd; }) ? "skin"
                                                                                 : "mucosa";
        }
        // Some files connect both sides by a face.
        const bool left = position_of(corners[0]).x > 0;
        if (!all([&](const ObjCorner& c) { return (position_of(c).x > 0) == left; })
            && material != "M_GumsTongue" && material != "M_Teeth") {
            return "";
        }
        if (material.starts_with("M_Sclera")) {
            return all([&](const ObjCorner& c) {
                const Vec3& p = position_of(c);
                return is_on_cornea(eye_at(p), p);
            })
                       ? "cornea"
                       : "sclera";
        }
        return material == "M_GumsTongue"       ? "mucosa"
               : material == "M_Teeth"          ? "teeth"
               : material.starts_with("M_Iris") ? "iris"
               : material == "M_LacrimalFluid"  ? "cornea"
               : material == "M_EyeLashes"      ? "lashes"
                                                : "";
    }

    const ObjFile& obj_;
    std::vector<Vec3> reference_;
    std::array<EyeBall, 2> eyes_;      ///< left, right
    std::vector<std::uint32_t> lids_;  ///< vertices of the face near an eye
};

}  // namespace

std::string ict_action_unit(std::string_view shape) {
    for (const auto& [name, unit] : kSidedUnits) {
        if (name == shape) {
            return std::string(unit);
        }
    }
    const auto [base, side] = split_shape_side(shape);
    for (const auto& [name, unit] : kUnits) {
        if (name == base) {
            return std::string(unit) + std::string(side);
        }
    }
    return "";
}

Result<GltfScene> import_ict_facekit(const std::string& folder, const ImportProgress& progress) {
    const std::filesystem::path root = folder;
    std::error_code ignored;
    const bool nested = std::filesystem::exists(root / "FaceXModel" / kNeutral, ignored);
    const std::filesystem::path models = nested ? root / "FaceXModel" : root;
    if (!nested && !std::filesystem::exists(models / kNeutral, ignored)) {
        return fail(
            "{}: found no {}, expected the folder FaceXModel of ICT FaceKit", folder, kNeutral);
    }
    const std::map<std::string, std::string> files = LIMN_TRY(find_expressions(models));
    const int total = static_cast<int>(files.size()) + 1;
    const ObjFile neutral = LIMN_TRY(load_mesh((models / kNeutral).string()));
    const std::vector<std::uint32_t> mirror = mirror_positions(neutral.positions);

    std::map<std::string, FaceShape> shapes;  // in alphabetical order
    int done = 1;
    for (const auto& [name, path] : files) {
        progress(done++, total);
        const ObjFile obj = LIMN_TRY(load_mesh(path));
        FaceShape shape = {name, ict_action_unit(name), {}};
        for (std::size_t i = 0; i < kVertices; ++i) {
            shape.offsets.push_back(obj.positions[i] - neutral.positions[i]);
        }
        const auto [base, side] = split_shape_side(name);
        const std::string other =
            side.empty() ? name : std::string(base) + (side == "_L" ? "_R" : "_L");
        if (!files.contains(other)) {
            shapes[other] = {other, ict_action_unit(other), mirror_offsets(shape.offsets, mirror)};
        }
        shapes[name] = std::move(shape);
    }
    progress(total, total);
    std::vector<FaceShape> list;
    for (auto& entry : shapes) {
        list.push_back(std::move(entry.second));
    }
    return IctImporter(neutral).make_scene(list);
}

}  // namespace limn
