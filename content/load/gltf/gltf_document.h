#pragma once

#include "content/load/files/json_document.h"
#include "content/load/gltf/gltf_load.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace limn {

// A glTF file while it is converted to a GltfScene, and the readers that do it, in the order in
// which gltf_load.cpp calls them.
//
// tinygltf parses the file (gltf_file.h) after check_gltf_schema has validated its JSON, so that
// the readers use the types and indices of `model` unchecked. A missing index is -1.

/// Location of the bytes of an image; images are loaded when a material uses them.
struct GltfImage {
    std::optional<std::string> uri;
    std::int32_t view = -1;
};

/// Morph weights of one node: a range of GltfScene::morph_weights.
struct GltfMorphs {
    std::int32_t first = -1;
    std::size_t count = 0;
};

struct GltfDocument {
    std::string file;    ///< prefix of messages
    std::string folder;  ///< base of relative URIs
    GltfLimits limits;
    tinygltf::Model model;
    JsonValue json;                 ///< of the file, without URIs; see extras_of
    std::vector<GltfImage> images;  ///< indexed as in the file
    std::vector<std::vector<std::byte>> decoded_views;  ///< bytes of those that were compressed
    std::uint64_t values_left = 0;                      ///< remaining of limits.max_values
    /// "accessors[3]" and other items that are left out, and why: stand-ins replace them.
    std::map<std::string, std::string> bad_parts;
    /// Scene node of each file node, or -1; set by build_nodes.
    std::vector<std::int32_t> scene_nodes;
    std::vector<GltfMorphs> node_morphs;  ///< per file node; set by build_nodes
    /// Scene nodes that stand for a skinned mesh, and the node that has it; set by build_nodes.
    std::vector<std::pair<std::size_t, std::uint32_t>> skinned_nodes;
    std::vector<std::string> warnings;
};

/// A bad part costs that part and a warning: "file: images[2]: found X, expected Y; COST".
inline void warn_of_loss(GltfDocument& document, const Error& error, std::string_view cost) {
    document.warnings.push_back(error.message + "; " + std::string(cost));
}

/// Validates the JSON of a file: every property that is read has the right type and range, and
/// every index refers to an existing item. Unknown properties are ignored, as the specification
/// requires. Bad parts are removed from the JSON, with a warning: "file: nodes[3].camera: found the
/// number 7, expected an index below 2; it is left out". Fails if a part that is drawn needs one.
/// Integers that are spelled as 1e3 or 7.0 become 1000 and 7, the only spelling of tinygltf.
[[nodiscard]] Status check_gltf_schema(GltfDocument& document);

/// Why item `index` of `array` ("meshes") is left out, or nullptr.
[[nodiscard]] const std::string*
find_bad_part(const GltfDocument& document, std::string_view array, std::size_t index);

// ---- values -------------------------------------------------------------------------------------

template <typename T>
[[nodiscard]] const T& item_at(const std::vector<T>& items, std::int32_t index) {
    return items[static_cast<std::size_t>(index)];
}

/// `missing` when there are none.
template <typename T>
[[nodiscard]] T vector_of(const std::vector<double>& values, T missing) {
    for (std::size_t i = 0; i < values.size(); ++i) {
        missing[static_cast<int>(i)] = static_cast<float>(values[i]);
    }
    return missing;
}

/// A null value when it is not there; so are members of null.
[[nodiscard]] const tinygltf::Value&
extension_of(const tinygltf::ExtensionMap& extensions, const char* name);
[[nodiscard]] const tinygltf::Value& member_of(const tinygltf::Value& object, const char* name);

[[nodiscard]] float number_of(const tinygltf::Value& object, const char* name, double missing);

template <typename T>
[[nodiscard]] T vector_of(const tinygltf::Value& object, const char* name, T missing) {
    const tinygltf::Value& values = member_of(object, name);
    const auto most = std::min(values.ArrayLen(), static_cast<std::size_t>(T::length()));
    for (std::size_t i = 0; i < most; ++i) {
        missing[static_cast<int>(i)] =
            static_cast<float>(values.Get(static_cast<int>(i)).GetNumberAsDouble());
    }
    return missing;
}

/// Of item `index` of the top-level array `array`. From the JSON, since tinygltf drops nulls and
/// empty objects, which shifts names and loses components, and casts integers to 32 bits.
[[nodiscard]] inline const JsonValue&
extras_of(const GltfDocument& document, std::string_view array, std::size_t index) {
    return document.json[array].items[index]["extras"];
}

// ---- accessors ----------------------------------------------------------------------------------

// Of any component type, with stride, normalized integers, sparse replacements or no buffer view
// (zeros). The extent is computed in 64 bits and checked against the view before a byte is read.
// The total number of values per file is limited, since a small file can reference the same bytes a
// million times.

/// Empty in a buffer without data. Fails for a view that is left out.
[[nodiscard]] Result<std::span<const std::byte>>
view_bytes(const GltfDocument& document, std::int32_t view);

/// All elements of accessor `index`, tightly packed; integers become floats, normalized ones 0 .. 1
/// or -1 .. 1. Fails unless elements have `components` components.
[[nodiscard]] Result<std::vector<float>> read_any_floats(
    GltfDocument& document, std::int32_t index, int components, const std::string& where);

/// The same, all finite.
[[nodiscard]] Result<std::vector<float>>
read_floats(GltfDocument& document, std::int32_t index, int components, const std::string& where);

/// The elements of accessor `index`, which must be unsigned integer scalars.
[[nodiscard]] Result<std::vector<std::uint32_t>>
read_indices(GltfDocument& document, std::int32_t index, const std::string& where);

// ---- readers ------------------------------------------------------------------------------------

/// Fills `scene.variants` and gives the primitives the materials of the variant `name`; "" is the
/// default. Fails where there is none of that name. Before the meshes and materials are built.
[[nodiscard]] Status
choose_variant(GltfDocument& document, const std::string& name, GltfScene& scene);

/// Fills `scene.materials`, in the file's order with the default material after them, and
/// `scene.images` with the images they use. An image used both as color and as data is stored
/// twice, since only one copy is sRGB.
[[nodiscard]] Status build_materials(GltfDocument& document, GltfScene& scene);

/// Primitive `primitive` of mesh `mesh` as triangles, points and lines as well, with normals,
/// tangents, bounds, skin weights for `joints` > 0 joints, and morph targets; unused vertices are
/// dropped. Empty when there is nothing to draw (no positions, no area); then a warning is added to
/// the document, as for attributes other than POSITION that are bad: they count as missing.
/// Triangles, lines and points with positions that are not finite are left out; normals and
/// tangents that are not finite, or 0, are recomputed; other numbers that are not finite get a
/// default. Fails on indices and positions out of range.
[[nodiscard]] Result<std::optional<MeshData>>
build_mesh(GltfDocument& document, std::size_t mesh, std::size_t primitive, std::size_t joints);

/// A primitive and its vertices in use, as element indices into its accessors.
struct GltfVertices {
    const tinygltf::Primitive& primitive;
    std::string where;  ///< "file: meshes[2].primitives[0]"
    std::size_t count;  ///< elements of each attribute
    std::span<const std::uint32_t> used;
};

/// JOINTS_n and WEIGHTS_n for all n; empty when the file has none. Weights of 0 are dropped, those
/// of a repeated joint are added, and all are normalized to sum to 1, with a warning where they
/// were off by more than 1e-3. Left out with a warning: joint indices >= `joints`, weights that are
/// negative or not finite. A vertex without weights is bound to the first joint, with a warning.
/// Fails when one of the two attributes is missing.
[[nodiscard]] Result<SkinWeights>
read_skin_weights(GltfDocument& document, const GltfVertices& vertices, std::size_t joints);

/// The morph targets of the primitive with the vertices that they move. Their names and action
/// units are the lists targetNames and actionUnits of `extras`, which may be shorter or missing;
/// targetDrivers has, by name, {"target": name, "peak": weight} for targets that follow others.
/// Fails where a driver is unknown or has drivers itself, and on a peak that is not above 0 and at
/// most 1. Normals may be NaN or infinite; positions and tangents that are become 0.
[[nodiscard]] Result<std::vector<MorphTarget>>
read_morph_targets(GltfDocument& document, const GltfVertices& vertices, const JsonValue& extras);

/// The regions _REGION_x, with their directions _ACROSS_x if there. Weights are clamped to 0 .. 1
/// and directions are normalized. Fails where a number is not finite, and on another number of
/// elements than POSITION has.
[[nodiscard]] Result<std::vector<VertexRegion>>
read_regions(GltfDocument& document, const GltfVertices& vertices);

/// The drawn parts of each mesh of the file.
using GltfParts = std::vector<std::vector<GltfPart>>;

/// Fills `scene.nodes` with the nodes of the file's scene, parents first, with their cameras and
/// lights, and `scene.morph_weights`. Fails when the graph has a cycle, a node with two parents or
/// is too deep, and where a node needs a part that is bad. A root that is a child of another root,
/// or listed twice, is added once, with a warning.
///
/// A skinned mesh is placed by its joints alone, so it gets its own root node after the others.
[[nodiscard]] Status build_nodes(GltfDocument& document, const GltfParts& parts, GltfScene& scene);

/// Fills the skeleton, skins and clips of `scene`, after its nodes. Joint 0 is the scene itself;
/// the others are the nodes that a skin or an animation references, and their ancestors, parents
/// first. A node with only animated morph weights is no joint.
///
/// Channels of an animation with the same times and interpolation share one sheet. Rotations are
/// normalized, each in the hemisphere of the previous key. Left out with a warning: unknown target
/// paths, weights of a node without morph targets, channels with the wrong number of values, with
/// decreasing times or of a property that another has, and skins with a joint that is not in the
/// scene or a singular matrix. Of keys at the same time, the later counts from then on; a key that
/// is not finite, or a rotation of length 0, gets the value of the previous key. Fails on too many
/// joints.
[[nodiscard]] Status build_animations(GltfDocument& document, GltfScene& scene);

/// Fills the components of the nodes of `scene` from extras.limn of the file's nodes, which may
/// reference nodes and assets of the scene by name. Fails on an unknown component, field or name,
/// and on a value of the wrong type.
[[nodiscard]] Status read_extras(const GltfDocument& document, GltfScene& scene);

}  // namespace limn
