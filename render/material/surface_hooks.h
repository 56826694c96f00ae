#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace limn {

class Variant;
struct Material;
struct SurfaceFeatures;
struct SurfaceHook;

// How effects extend the programs that draw surfaces. What any surface may need is a SurfaceFeature
// and in lib/material.glsl; what one effect adds, such as wrinkles, is a SurfaceHook: a small set
// of bits whose meaning is private to the effect, their definitions, and GLSL files with functions
// that the shaders call. A hook is declared in a file of its effect (wrinkle_hook.h) and has a line
// in the list of surface_hooks.cpp, whose order is that of the calls.
//
// Shaders include what is generated from the list:
//
//     generated/position_hooks.glsl   HookPoint::Position, of all passes that draw meshes
//     generated/vertex_hooks.glsl     HookPoint::Vertex, of mesh.vert
//     generated/surface_hooks.glsl    all other points, of lib/material.glsl
//
// The file of a hook is part of every such program and has a function for each of its points,
// which does nothing unless its definitions are set.

// A hook may find the visible point off the mesh, below a fragment. It then has the bit of the
// definition OFF_MESH and sets, at HookPoint::Uv, surface_depth, surface_offset and surface_hole
// (lib/material.glsl); passes that draw depth alone call it, too.

/// Where a hook is called: each is a function `<hook>_<point>`.
enum class HookPoint : std::uint8_t {
    Position,  ///< (inout vec3 position): moves a vertex in mesh space
    Vertex,    ///< (inout vec3 tangent, vec3 normal): in world space; writes varyings of the effect
    Uv,        ///< (inout vec4 uv): both sets of texture coordinates, before any map is read
    Color,     ///< (inout vec4 color): before the colors of vertices
    Normal,    ///< (inout vec3 normal): in tangent space, not unit; after the normal maps
    Sample,    ///< (inout SurfaceSample s, vec3 smooth_normal): the finished sample, and its unit
               ///< normal as it was before the hooks
};

inline constexpr std::size_t kMaxSurfaceHooks = 4;

/// The bits of all hooks, 16 each.
class HookBits {
  public:
    [[nodiscard]] std::uint16_t of(const SurfaceHook& hook) const;
    void set(const SurfaceHook& hook, std::uint16_t bits);
    /// Different for different bits.
    [[nodiscard]] std::uint64_t key() const { return bits_; }
    bool operator==(const HookBits&) const = default;

  private:
    std::uint64_t bits_ = 0;
};

struct HookDefinition {
    std::uint16_t bit;
    const char* name;
};

struct SurfaceHook {
    const char* name;                   ///< prefix of its functions
    std::span<const HookPoint> points;  ///< where it is called
    std::span<const HookDefinition> definitions;
    std::uint16_t moving = 0;    ///< bits with which it moves vertices
    std::uint16_t off_mesh = 0;  ///< bits with which fragments lie off the mesh
    std::uint32_t maps = 0;      ///< with moving or off_mesh: bits of the map slots that it reads
    const char* position_file = nullptr;  ///< with HookPoint::Position
    const char* vertex_file = nullptr;    ///< with HookPoint::Vertex
    const char* surface_file = nullptr;   ///< with any other point
    /// The bits of a material, of all its instances; null: none.
    std::uint16_t (*of_material)(const Material& material) = nullptr;
    /// Adds to the features of a material what the hook needs for an instance with these bits; also
    /// called for instances without any.
    void (*add)(SurfaceFeatures& features, std::uint16_t instance);
};

/// In the order of their calls.
[[nodiscard]] std::span<const SurfaceHook* const> surface_hooks();

/// SurfaceHook::of_material of each.
[[nodiscard]] HookBits material_hooks(const Material& material);

/// Calls SurfaceHook::add of each.
void add_hooks(SurfaceFeatures& features, const HookBits& instance);

/// Adds the hooks of `features` that move vertices, and their maps, to those of a depth-only pass.
void add_moving_hooks(SurfaceFeatures& depth_only, const SurfaceFeatures& features);

/// Whether some hook has fragments lie off the mesh.
[[nodiscard]] bool is_off_mesh(const SurfaceFeatures& features);

/// Adds the hooks of `features` with which fragments lie off the mesh, and their maps, to those of
/// a depth-only pass.
void add_off_mesh_hooks(SurfaceFeatures& depth_only, const SurfaceFeatures& features);

/// Removes them and those that move vertices by their maps, for programs that shade vertices.
void remove_off_mesh_hooks(SurfaceFeatures& features);

/// Adds the definition of each bit.
void add_hook_definitions(Variant& variant, const HookBits& hooks);

// ---- generated GLSL ----

[[nodiscard]] std::string hooks_glsl(
    std::span<const SurfaceHook* const> hooks, const char* SurfaceHook::*file,
    std::span<const HookPoint> points);
[[nodiscard]] std::string position_hooks_glsl();
[[nodiscard]] std::string vertex_hooks_glsl();
[[nodiscard]] std::string surface_hooks_glsl();

}  // namespace limn
