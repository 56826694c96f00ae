#pragma once

#include "content/load/gltf_load.h"
#include "content/load/json_document.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace limn {

// A glTF file while it is converted to a GltfScene, and the readers that do it, in the order in
// which gltf_load.cpp calls them.
//
// The JSON is parsed once; check_gltf_schema has validated it, so that the readers use its types
// and indices unchecked. A missing member reads as null, without items and with an empty text.

/// Bytes of a buffer view.
struct GltfView {
    std::span<const std::byte> bytes;
    std::uint64_t stride = 0;  ///< between elements; 0 = tightly packed
};

/// Component types of an accessor.
inline constexpr int kGltfByte = 5120;
inline constexpr int kGltfUnsignedByte = 5121;
inline constexpr int kGltfShort = 5122;
inline constexpr int kGltfUnsignedShort = 5123;
inline constexpr int kGltfUnsignedInt = 5125;
inline constexpr int kGltfFloat = 5126;

struct GltfAccessor {
    std::int32_t view = -1;  ///< none: zeros
    std::uint64_t offset = 0;
    std::uint64_t count = 0;  ///< of elements
    int type = 0;             ///< of a component
    int components = 1;       ///< per element; 0 if glTF has no such type
    bool normalized = false;
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
    JsonValue json;
    std::vector<std::vector<std::byte>> buffers;  ///< indexed as in the file
    std::vector<GltfView> views;                  ///< indexed as in the file
    std::uint64_t values_left = 0;                ///< remaining of limits.max_values
    /// Scene node of each file node, or -1; set by build_nodes.
    std::vector<std::int32_t> scene_nodes;
    std::vector<GltfMorphs> node_morphs;  ///< per file node; set by build_nodes
    std::vector<std::string> warnings;
};

/// Validates the JSON of a file: every property that is read has the right type and range, and
/// every index refers to an existing item. Unknown properties are ignored, as the specification
/// requires. Fails with "file: nodes[3].mesh: found the number 7, expected an index below 2".
[[nodiscard]] Status check_gltf_schema(const JsonValue& json, const std::string& file);

/// Reads container, JSON and buffers; images are loaded with the materials.
[[nodiscard]] Result<GltfDocument> open_gltf(
    std::span<const std::byte> bytes, const std::string& file, const std::string& folder,
    const GltfLimits& limits);

// ---- values -------------------------------------------------------------------------------------

/// -1 for a missing member.
[[nodiscard]] inline std::int32_t index_of(const JsonValue& value) {
    return value.kind == JsonKind::Number ? static_cast<std::int32_t>(value.number) : -1;
}

[[nodiscard]] inline float number_of(const JsonValue& value, double missing) {
    return static_cast<float>(value.kind == JsonKind::Number ? value.number : missing);
}

template <typename T>
[[nodiscard]] T vector_of(const JsonValue& value, T missing) {
    for (std::size_t i = 0; i < value.items.size(); ++i) {
        missing[static_cast<int>(i)] = static_cast<float>(value.items[i].number);
    }
    return missing;
}

/// Item `index` of the top-level array `array`, which must exist.
[[nodiscard]] inline const JsonValue&
json_item(const GltfDocument& document, std::string_view array, std::int32_t index) {
    return document.json[array].items[static_cast<std::size_t>(index)];
}

// ---- accessors ----------------------------------------------------------------------------------

// Of any component type, with stride, normalized integers, sparse replacements or no buffer view
// (zeros). The extent is computed in 64 bits and checked against the view before a byte is read.
// The total number of values per file is limited, since a small file can reference the same bytes a
// million times.

[[nodiscard]] GltfAccessor accessor_at(const GltfDocument& document, std::int32_t index);

/// All elements of accessor `index`, tightly packed; integers become floats, normalized ones 0 .. 1
/// or -1 .. 1. Fails unless elements have `components` components and all are finite.
[[nodiscard]] Result<std::vector<float>>
read_floats(GltfDocument& document, std::int32_t index, int components, const std::string& place);

/// The elements of accessor `index`, which must be unsigned integer scalars.
[[nodiscard]] Result<std::vector<std::uint32_t>>
read_indices(GltfDocument& document, std::int32_t index, const std::string& place);

// ---- readers ------------------------------------------------------------------------------------

/// Fills `scene.materials`, in the file's order with the default material after them, and
/// `scene.images` with the images they use. An image used both as color and as data is stored
/// twice, since only one copy is sRGB.
[[nodiscard]] Status build_materials(GltfDocument& document, GltfScene& scene);

/// Primitive `primitive` of mesh `mesh` as triangles, points and lines as well, with normals,
/// tangents, bounds, skin weights for `joints` > 0 joints, and morph targets; unused vertices are
/// dropped. Empty when there is nothing to draw (no positions, no area); then a warning is added to
/// the document.
[[nodiscard]] Result<std::optional<MeshData>>
build_mesh(GltfDocument& document, std::size_t mesh, std::size_t primitive, std::size_t joints);

/// A primitive and its vertices in use, as element indices into its accessors.
struct GltfVertices {
    const JsonValue& primitive;
    std::string place;  ///< "file: meshes[2].primitives[0]"
    std::size_t count;  ///< elements of each attribute
    std::span<const std::uint32_t> used;
};

/// JOINTS_n and WEIGHTS_n for all n; empty when the file has none. Weights of 0 are dropped, those
/// of a repeated joint are added, and all are normalized to sum to 1, with a warning where they
/// were off by more than 1e-3. A vertex without weights is bound to the first joint, with a
/// warning. Fails on a joint index >= `joints`, a negative weight, or when one of the two
/// attributes is missing.
[[nodiscard]] Result<SkinWeights>
read_skin_weights(GltfDocument& document, const GltfVertices& vertices, std::size_t joints);

/// The morph targets of the primitive with the vertices that they move. Their names and action
/// units are the lists targetNames and actionUnits of `extras`, which may be shorter or missing;
/// targetDrivers has {"target": name, "peak": weight} of those that follow others, by name. Fails
/// where a driver is unknown or has drivers itself, and on a peak that is not above 0 and at
/// most 1.
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
/// is too deep, and when the number of a node's weights differs from the morph targets of its mesh.
///
/// A skinned mesh is placed by its joints alone, so it gets its own root node after the others.
[[nodiscard]] Status build_nodes(GltfDocument& document, const GltfParts& parts, GltfScene& scene);

/// Fills the skeleton, skins and clips of `scene`, after its nodes. Joint 0 is the scene itself;
/// the others are the nodes that a skin or an animation references, and their ancestors, parents
/// first. A node with only animated morph weights is no joint.
///
/// Channels of an animation with the same times and interpolation share one sheet. Rotations are
/// normalized, each in the hemisphere of the previous key. Ignored with a warning: unknown target
/// paths, and weights of a node without morph targets. Fails when a sampler has the wrong number of
/// values, times are not increasing, a rotation has length 0, two channels animate the same
/// property, a joint is not in the scene, or a matrix of a skin is singular.
[[nodiscard]] Status build_animations(GltfDocument& document, GltfScene& scene);

/// Fills the components of the nodes of `scene` from extras.limn of the file's nodes, which may
/// reference nodes and assets of the scene by name. Fails on an unknown component, field or name,
/// and on a value of the wrong type.
[[nodiscard]] Status read_extras(const GltfDocument& document, GltfScene& scene);

}  // namespace limn
