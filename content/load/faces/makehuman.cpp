#include "content/load/faces/makehuman.h"

#include "content/bake/point_warp.h"
#include "content/load/faces/makehuman_files.h"
#include "content/load/files/atomic_file.h"
#include "content/load/files/json_document.h"
#include "content/load/obj/obj_file.h"
#include "content/load/obj/obj_subdivision.h"
#include "ecs/base/text.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace limn {

namespace {

constexpr float kMakehumanScale = 0.1f;  // the files are in decimeters
constexpr std::size_t kMakehumanVertices = 19158;
constexpr float kMakehumanLimbus = 0.57f;  ///< of the radius of an eye
constexpr std::size_t kEyeVertices = 256;  ///< of the outer shell of an eye; an inner one follows

struct UnitOfTarget {
    std::string_view target;
    std::string_view unit;
};

/// Action units of the targets, after Ekman and Friesen 1978.
constexpr UnitOfTarget kMakehumanUnits[] = {
    {"eye-left-closure", "AU43_L"},
    {"eye-right-closure", "AU43_R"},
    {"eye-left-opened-up", "AU5_L"},
    {"eye-right-opened-up", "AU5_R"},
    {"eye-left-slit", "AU42_L"},
    {"eye-right-slit", "AU42_R"},
    {"eyebrows-left-down", "AU4_L"},
    {"eyebrows-right-down", "AU4_R"},
    {"eyebrows-left-extern-up", "AU2_L"},
    {"eyebrows-right-extern-up", "AU2_R"},
    {"eyebrows-left-inner-up", "AU1_L"},
    {"eyebrows-right-inner-up", "AU1_R"},
    {"mouth-compression", "AU24"},
    {"mouth-corner-puller", "AU12"},
    {"mouth-depression", "AU15"},
    {"mouth-elevation", "AU10"},
    {"mouth-eversion", "AU22"},
    {"mouth-open", "AU27"},
    {"mouth-parling", "AU25"},
    {"mouth-pursing", "AU18"},
    {"mouth-retraction", "AU20"},
    {"neck-platysma", "AU21"},
    {"nose-compression", "AU39"},
    {"nose-left-dilatation", "AU38_L"},
    {"nose-right-dilatation", "AU38_R"},
    {"nose-left-elevation", "AU9_L"},
    {"nose-right-elevation", "AU9_R"},
};

/// A vertex of the base mesh on the midline or the left, and the same point of the reference face
/// of make_face_regions [cm].
struct Landmark {
    std::uint32_t vertex;
    Vec3 reference;
};

constexpr Landmark kLandmarks[] = {
    {5192, {0, 9.4f, 9.65f}},            // forehead
    {227, {0, 5.735f, 10.768f}},         // glabella
    {132, {0, 3.741f, 10.734f}},         // root of the nose
    {5054, {0, 0.406f, 13.069f}},        // its tip
    {343, {0, -1.203f, 11.566f}},        // its base
    {362, {0, -2.483f, 11.839f}},        // upper border of the lips
    {523, {0, -3.36f, 11.27f}},          // between them
    {492, {0, -4.377f, 11.549f}},        // their lower border
    {724, {0, -5.2f, 10.93f}},           // furrow above the chin
    {733, {0, -6.1f, 11.05f}},           // chin
    {5171, {0, -7.567f, 10.432f}},       // its lower end
    {6850, {1.844f, 3.252f, 9.196f}},    // inner corner of the eye
    {6807, {4.459f, 3.432f, 8.603f}},    // its outer corner
    {6785, {3.05f, 3.93f, 9.5f}},        // center of the upper lid
    {6828, {3.05f, 3.05f, 9.36f}},       // center of the lower lid
    {7006, {1.69f, 6.1f, 10.65f}},       // inner end of the brow
    {7005, {4.93f, 5.98f, 8.99f}},       // its outer end
    {10405, {2.535f, -3.52f, 10.188f}},  // corner of the mouth
    {7102, {1.87f, 0, 10.6f}},           // wing of the nose
    {7613, {6.557f, -2.356f, 5.174f}},   // jaw
    {11849, {5.724f, -4.487f, 6.127f}},  // jaw in front of it
};

Result<std::string> read_text(const std::filesystem::path& path) {
    const std::vector<std::byte> bytes = LIMN_TRY(read_file(path.string(), 1u << 28));
    return std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

/// The .target files of a folder by name; none if it does not exist.
std::map<std::string, std::filesystem::path>
find_makehuman_targets(const std::filesystem::path& folder) {
    std::map<std::string, std::filesystem::path> found;
    std::error_code error;
    for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error)) {
        if (entry->path().extension() == ".target") {
            found.emplace(entry->path().stem().string(), entry->path());
        }
    }
    return found;
}

/// Displacement of every vertex [dm].
Result<std::vector<Vec3>> read_target(const std::filesystem::path& path) {
    const std::string text = LIMN_TRY(read_text(path));
    std::vector<Vec3> offsets(kMakehumanVertices, Vec3(0));
    for (const MakehumanOffset& moved :
         LIMN_TRY(parse_makehuman_target(text, path.string(), kMakehumanVertices))) {
        offsets[moved.vertex] += moved.offset;
    }
    return offsets;
}

using Influences = std::vector<std::pair<std::uint16_t, float>>;

/// The default rig: bones, parents first, and which bones move each vertex.
struct Rig {
    std::vector<std::string> names;
    std::vector<std::int32_t> parents;
    std::vector<Vec3> heads;             ///< [dm]
    std::vector<Influences> influences;  ///< of each vertex, not normalized
};

class RigReader {
  public:
    RigReader(std::string file, const JsonValue& json, std::span<const Vec3> positions)
        : file_(std::move(file)), json_(json), positions_(positions) {}

    Result<Rig> read(const JsonValue& weights, const std::string& weights_file) {
        for (const JsonMember& bone : json_["bones"].members) {
            LIMN_TRY(add_bone(bone.key, 0));
        }
        if (rig_.names.empty()) {
            return fail("{}: found no bones", file_);
        }
        rig_.influences.resize(positions_.size());
        for (const JsonMember& bone : weights["weights"].members) {
            LIMN_TRY(add_weights(bone, weights_file));
        }
        return std::move(rig_);
    }

  private:
    static constexpr int kMaxDepth = 256;
    static constexpr std::size_t kMaxBones = 4096;

    /// The index of the bone, whose ancestors are added first.
    Result<std::int32_t> add_bone(const std::string& name, int depth) {
        if (const auto known = numbers_.find(name); known != numbers_.end()) {
            return known->second;
        }
        const JsonValue* const bone = json_["bones"].find(name);
        if (bone == nullptr || depth > kMaxDepth || rig_.names.size() == kMaxBones) {
            return fail(
                "{}: found the bone {}, expected one of a tree of at most {}", file_,
                in_quotes(name), kMaxBones);
        }
        const JsonValue& parent = (*bone)["parent"];
        const std::int32_t above =
            parent.kind == JsonKind::String ? LIMN_TRY(add_bone(parent.text, depth + 1)) : -1;
        const Vec3 head = LIMN_TRY(joint_at((*bone)["head"].text, bone->at));
        const auto number = static_cast<std::int32_t>(rig_.names.size());
        numbers_.emplace(name, number);
        rig_.names.push_back(name);
        rig_.parents.push_back(above);
        rig_.heads.push_back(head);
        return number;
    }

    /// The mean of the vertices of a joint.
    Result<Vec3> joint_at(const std::string& name, SourcePosition at) const {
        const std::vector<JsonValue>& vertices = json_["joints"][name].items;
        Vec3 sum = Vec3(0);
        for (const JsonValue& vertex : vertices) {
            sum += positions_[LIMN_TRY(vertex_of(vertex, file_))];
        }
        if (vertices.empty()) {
            return fail("{}: found no joint {}", location_text(file_, at), in_quotes(name));
        }
        return sum / static_cast<float>(vertices.size());
    }

    Result<std::size_t> vertex_of(const JsonValue& value, const std::string& file) const {
        const auto count = static_cast<double>(positions_.size());
        if (value.kind != JsonKind::Number || !(value.number >= 0) || value.number >= count) {
            return fail(
                "{}: found {}, expected a vertex below {}", location_text(file, value.at),
                describe(value), positions_.size());
        }
        return static_cast<std::size_t>(value.number);
    }

    Status add_weights(const JsonMember& bone, const std::string& file) {
        const auto number = numbers_.find(bone.key);
        if (number == numbers_.end()) {
            return fail(
                "{}: found weights of {}, expected a bone of {}", location_text(file, bone.at),
                in_quotes(bone.key), file_);
        }
        for (const JsonValue& pair : bone.value.items) {
            if (pair.items.size() != 2 || pair.items[1].kind != JsonKind::Number
                || !(pair.items[1].number >= 0)) {
                return fail(
                    "{}: found {}, expected [vertex, weight]", location_text(file, pair.at),
                    describe(pair));
            }
            const std::size_t vertex = LIMN_TRY(vertex_of(pair.items[0], file));
            rig_.influences[vertex].emplace_back(
                static_cast<std::uint16_t>(number->second),
                static_cast<float>(pair.items[1].number));
        }
        return Done{};
    }

    std::string file_;
    const JsonValue& json_;
    std::span<const Vec3> positions_;
    Rig rig_;
    std::map<std::string, std::int32_t> numbers_;
};

/// Normalized; vertices without any follow the first bone.
SkinWeights normalized(std::span<const Influences> influences) {
    SkinWeights skin;
    for (const Influences& all : influences) {
        skin.first.push_back(static_cast<std::uint32_t>(skin.joints.size()));
        std::map<std::uint16_t, double> merged;
        double sum = 0;
        for (const auto& [joint, weight] : all) {
            merged[joint] += static_cast<double>(weight);
            sum += static_cast<double>(weight);
        }
        if (!(sum > 1e-6)) {
            merged = {{std::uint16_t{0}, 1.0}};
            sum = 1;
        }
        for (const auto& [joint, weight] : merged) {
            if (weight / sum > 1e-4) {
                skin.joints.push_back(joint);
                skin.weights.push_back(static_cast<float>(weight / sum));
            }
        }
    }
    skin.first.push_back(static_cast<std::uint32_t>(skin.joints.size()));
    return skin;
}

/// Skins the parts of the only node of `scene` to the rig, like the glTF loader.
void add_makehuman_rig(GltfScene& scene, const Rig& rig) {
    GltfNode body = scene.nodes[0];
    body.name += ".skin";
    body.skin = 0;
    scene.nodes[0].parts.clear();
    scene.nodes[0].first_morph = -1;
    scene.joints = {-1};
    scene.skeleton.name = scene.name;
    const auto add_joint = [&](const std::string& name, std::int32_t parent, const Vec3& at) {
        scene.skeleton.joints.push_back(name);
        scene.skeleton.parents.push_back(parent);
        scene.skeleton.rest.translations.push_back(at);
        scene.skeleton.rest.rotations.emplace_back(1.0f, 0.0f, 0.0f, 0.0f);
        scene.skeleton.rest.scales.emplace_back(1.0f);
    };
    add_joint(scene.name, -1, Vec3(0));
    SkinData skin;
    skin.name = "rig";
    for (std::size_t i = 0; i < rig.names.size(); ++i) {
        const std::int32_t parent = rig.parents[i];
        const Vec3 above = parent < 0 ? Vec3(0) : rig.heads[static_cast<std::size_t>(parent)];
        GltfNode node;
        node.name = rig.names[i];
        node.parent = parent < 0 ? -1 : parent + 1;
        node.transform.position = kMakehumanScale * (rig.heads[i] - above);
        add_joint(node.name, parent + 1, node.transform.position);
        scene.nodes.push_back(std::move(node));
        scene.joints.push_back(static_cast<std::int32_t>(i) + 1);
        skin.joints.push_back(static_cast<std::uint16_t>(i + 1));
        skin.joint_from_mesh.push_back(
            affine_from(-kMakehumanScale * rig.heads[i], Quat(1, 0, 0, 0), Vec3(1)));
    }
    scene.skins.push_back(std::move(skin));
    scene.nodes.push_back(std::move(body));
    scene.joints.push_back(-1);
}

class MakehumanImporter {
  public:
    MakehumanImporter(std::filesystem::path folder, const ImportProgress& progress)
        : folder_(std::move(folder)), progress_(progress) {}

    Result<GltfScene> read() {
        const std::string base = (folder_ / "base.obj").string();
        obj_ = LIMN_TRY(load_intact_obj(base));
        if (obj_.positions.size() != kMakehumanVertices) {
            return fail(
                "{}: found {} vertices, expected the {} of the base mesh hm08", base,
                obj_.positions.size(), kMakehumanVertices);
        }
        LIMN_TRY(read_shapes());
        LIMN_TRY(find_reference());
        LIMN_TRY(read_rig());
        LIMN_TRY(read_eyes());
        subdivide_face();
        const SkinWeights skin = rig_ ? normalized(rig_->influences) : SkinWeights{};
        GltfScene scene = make_face_scene(
            "person", obj_, kMakehumanScale, make_parts(), shapes_, reference_, skin);
        if (rig_) {
            add_makehuman_rig(scene, *rig_);
        }
        return scene;
    }

  private:
    Status read_shapes() {
        const auto expressions = find_makehuman_targets(folder_ / "targets" / "expression");
        const auto macros = find_makehuman_targets(folder_ / "targets" / "macrodetails");
        if (expressions.empty()) {
            return fail(
                "{}: found no targets, expected files such as mouth-open.target",
                (folder_ / "targets" / "expression").string());
        }
        const int total = static_cast<int>(expressions.size() + macros.size()) + 1;
        int done = 1;
        for (const auto& [name, path] : expressions) {
            progress_(done++, total);
            shapes_.push_back({name, makehuman_action_unit(name), LIMN_TRY(read_target(path))});
        }
        std::vector<FaceShape> builds;
        for (const auto& [name, path] : macros) {
            progress_(done++, total);
            builds.push_back({name, "", LIMN_TRY(read_target(path))});
        }
        progress_(total, total);
        apply_mean(builds);
        std::move(builds.begin(), builds.end(), std::back_inserter(shapes_));
        return Done{};
    }

    /// Morphs the base mesh to the mean of the young builds, makes everything relative to that, and
    /// stands it on y = 0.
    void apply_mean(std::vector<FaceShape>& builds) {
        std::vector<Vec3> mean(kMakehumanVertices, Vec3(0));
        const auto is_young = [](const FaceShape& build) { return build.name.ends_with("young"); };
        const auto count = std::count_if(builds.begin(), builds.end(), is_young);
        for (const FaceShape& build : builds) {
            for (std::size_t i = 0; i < kMakehumanVertices && is_young(build); ++i) {
                mean[i] += build.offsets[i] / static_cast<float>(count);
            }
        }
        float ground = std::numeric_limits<float>::infinity();
        for (const ObjFace& face : obj_.faces) {
            for (std::uint32_t k = 0; k < face.count && obj_.groups[face.group] == "body"; ++k) {
                const std::uint32_t p = obj_.corners[face.first + k].position;
                ground = std::min(ground, obj_.positions[p].y + mean[p].y);
            }
        }
        for (std::size_t i = 0; i < kMakehumanVertices; ++i) {
            obj_.positions[i] += mean[i] - Vec3(0, std::isfinite(ground) ? ground : 0.0f, 0);
        }
        for (FaceShape& build : builds) {
            for (std::size_t i = 0; i < kMakehumanVertices; ++i) {
                build.offsets[i] -= mean[i];
            }
        }
    }

    Status find_reference() {
        std::vector<Vec3> from;
        std::vector<Vec3> to;
        for (const auto& [vertex, reference] : kLandmarks) {
            const Vec3 p = obj_.positions[vertex];
            from.push_back(p);
            to.push_back(reference);
            if (reference.x > 0) {  // the mesh is symmetric
                from.push_back(p * Vec3(-1, 1, 1));
                to.push_back(reference * Vec3(-1, 1, 1));
            }
        }
        const PointWarp warp = LIMN_TRY(make_point_warp(from, to));
        reference_.assign(kMakehumanVertices, Vec3(std::numeric_limits<float>::quiet_NaN()));
        for (const ObjFace& face : obj_.faces) {
            for (std::uint32_t k = 0; k < face.count && obj_.groups[face.group] == "body"; ++k) {
                const std::uint32_t p = obj_.corners[face.first + k].position;
                const Vec3 warped = warp_point(warp, obj_.positions[p]);
                const bool near =
                    std::abs(warped.x) < 10 && std::abs(warped.y) < 12 && warped.z > 0;
                reference_[p] = near ? warped : reference_[p];
            }
        }
        return Done{};
    }

    Status read_rig() {
        const std::filesystem::path file = folder_ / "rigs" / "default.mhskel";
        std::error_code ignored;
        if (!std::filesystem::exists(file, ignored)) {
            return Done{};
        }
        const JsonValue json = LIMN_TRY(load_json(file.string()));
        const std::string weights_file = (folder_ / "rigs" / "default_weights.mhw").string();
        const JsonValue weights = LIMN_TRY(load_json(weights_file));
        rig_ = LIMN_TRY(RigReader(file.string(), json, obj_.positions).read(weights, weights_file));
        return Done{};
    }

    /// Appends the eyes, which move with the base mesh, to the mesh and its vertex attributes.
    Status read_eyes() {
        const std::filesystem::path folder = folder_ / "proxies";
        std::error_code ignored;
        if (!std::filesystem::exists(folder / "eyes-high-poly.mhclo", ignored)) {
            return Done{};
        }
        const std::string file = (folder / "eyes-high-poly.mhclo").string();
        const std::string text = LIMN_TRY(read_text(file));
        const MakehumanProxy proxy =
            LIMN_TRY(parse_makehuman_proxy(text, file, kMakehumanVertices));
        const std::string mesh_file = (folder / "eyes-high-poly.obj").string();
        const ObjFile eyes = LIMN_TRY(load_intact_obj(mesh_file));
        if (eyes.positions.size() != proxy.fits.size()) {
            return fail(
                "{}: found {} vertices, expected the {} of {}", mesh_file, eyes.positions.size(),
                proxy.fits.size(), file);
        }
        const std::vector<Vec3> fitted =
            fit_proxy(proxy, std::span(obj_.positions).first(kMakehumanVertices));
        append_faces(eyes);
        eye_vertices_ = std::max<std::size_t>(eyes.positions.size() / 2, 1);
        obj_.positions.insert(obj_.positions.end(), fitted.begin(), fitted.end());
        for (FaceShape& shape : shapes_) {
            const std::vector<Vec3> moved = fit_offsets(proxy, shape.offsets);
            shape.offsets.insert(shape.offsets.end(), moved.begin(), moved.end());
        }
        for (const MakehumanFit& fit : proxy.fits) {
            reference_.emplace_back(std::numeric_limits<float>::quiet_NaN());
            if (rig_) {
                Influences all;
                for (int k = 0; k < 3; ++k) {
                    const std::uint32_t v = fit.vertices[static_cast<std::size_t>(k)];
                    for (const auto& [joint, weight] : rig_->influences[v]) {
                        all.emplace_back(joint, weight * std::max(fit.weights[k], 0.0f));
                    }
                }
                rig_->influences.push_back(std::move(all));
            }
        }
        for (std::size_t side = 0; side < 2; ++side) {
            const std::size_t first = side * eye_vertices_;
            const std::size_t count = std::min(kEyeVertices, eyes.positions.size() - first);
            eyes_[side] = find_eye_ball(std::span(fitted).subspan(first, count), kMakehumanLimbus);
        }
        return Done{};
    }

    /// Subdivides the skin of the face: the base mesh was modeled as a cage, with edges too long
    /// for normals and strain to vary smoothly.
    void subdivide_face() {
        std::vector<char> chosen;
        for (const ObjFace& face : obj_.faces) {
            const std::span<const ObjCorner> corners(&obj_.corners[face.first], face.count);
            chosen.push_back(std::ranges::all_of(corners, [this](const ObjCorner& corner) {
                return is_finite(reference_[corner.position]);
            }));
        }
        const PointMeans means = subdivide_obj(obj_, chosen);
        reference_ = apply_means<Vec3>(means, reference_);
        for (FaceShape& shape : shapes_) {
            shape.offsets = apply_means<Vec3>(means, shape.offsets);
        }
        if (!rig_) {
            return;
        }
        std::vector<Influences> influences(obj_.positions.size());
        for (std::size_t p = 0; p < influences.size(); ++p) {
            for (std::uint32_t i = means.first[p]; i < means.first[p + 1]; ++i) {
                for (const auto& [joint, weight] : rig_->influences[means.points[i]]) {
                    influences[p].emplace_back(joint, weight * std::max(means.weights[i], 0.0f));
                }
            }
        }
        rig_->influences = std::move(influences);
    }

    void append_faces(const ObjFile& eyes) {
        const auto uvs = static_cast<std::int32_t>(obj_.uvs.size());
        const auto group = static_cast<std::uint32_t>(obj_.groups.size());
        obj_.groups.emplace_back("eyes");
        obj_.uvs.insert(obj_.uvs.end(), eyes.uvs.begin(), eyes.uvs.end());
        for (ObjFace face : eyes.faces) {
            const std::span<const ObjCorner> corners(&eyes.corners[face.first], face.count);
            face = {
                .first = static_cast<std::uint32_t>(obj_.corners.size()),
                .count = face.count,
                .group = group};
            obj_.faces.push_back(face);
            for (const ObjCorner& corner : corners) {
                obj_.corners.push_back(
                    {.position = corner.position + static_cast<std::uint32_t>(kMakehumanVertices),
                     .uv = corner.uv < 0 ? -1 : corner.uv + uvs});
            }
        }
    }

    [[nodiscard]] const EyeBall& eye_at(const Vec3& p) const { return eyes_[p.x < 0 ? 1 : 0]; }

    [[nodiscard]] std::string_view part_of(const ObjFace& face) const {
        const std::string& group = obj_.groups[face.group];
        if (group == "body") {
            return "skin";
        }
        if (group == "helper-upper-teeth" || group == "helper-lower-teeth") {
            return "teeth";
        }
        if (group == "helper-tongue") {
            return "mucosa";
        }
        if (group != "eyes") {
            return "";
        }
        const std::span<const ObjCorner> corners(&obj_.corners[face.first], face.count);
        if ((corners[0].position - kMakehumanVertices) % eye_vertices_ >= kEyeVertices) {
            return "iris";
        }
        const bool on_cornea = std::all_of(corners.begin(), corners.end(), [&](const ObjCorner& c) {
            const Vec3& p = obj_.positions[c.position];
            return is_on_cornea(eye_at(p), p);
        });
        return on_cornea ? "cornea" : "sclera";
    }

    [[nodiscard]] std::vector<FacePart> make_parts() const {
        const auto tint = [this](std::uint32_t p) { return skin_tint(reference_[p]); };
        const auto iris = [this](std::uint32_t p) {
            return iris_color(eye_at(obj_.positions[p]), obj_.positions[p]);
        };
        std::vector<FacePart> parts = {
            {.material = skin_material(), .faces = {}, .color = tint, .is_skin = true},
            {.material = mucosa_material(), .faces = {}},
            {.material = teeth_material(), .faces = {}},
            {.material = sclera_material(), .faces = {}},
            {.material = iris_material(), .faces = {}, .color = iris},
            {.material = cornea_material(), .faces = {}}};
        for (std::uint32_t f = 0; f < obj_.faces.size(); ++f) {
            for (FacePart& part : parts) {
                if (part.material.name == part_of(obj_.faces[f])) {
                    part.faces.push_back(f);
                }
            }
        }
        return parts;
    }

    std::filesystem::path folder_;
    const ImportProgress& progress_;
    ObjFile obj_;  ///< the eyes after the base mesh, then points that subdivide the face
    std::size_t eye_vertices_ = 0;  ///< of one eye
    std::vector<FaceShape> shapes_;
    std::vector<Vec3> reference_;
    std::optional<Rig> rig_;
    std::array<EyeBall, 2> eyes_;  ///< left, right
};

}  // namespace

std::string makehuman_action_unit(std::string_view target) {
    for (const auto& [name, unit] : kMakehumanUnits) {
        if (name == target) {
            return std::string(unit);
        }
    }
    return "";
}

Result<GltfScene> import_makehuman(const std::string& folder, const ImportProgress& progress) {
    return MakehumanImporter(folder, progress).read();
}

}  // namespace limn
