#pragma once

#include "content/load/obj/obj_material.h"
#include "ecs/components/surface.h"

#include <cstdint>
#include <map>
#include <string>

namespace limn {

struct GltfScene;

// The engine's materials from those of a library, with their images. An image that is missing or
// damaged leaves a warning and a material without it.

class ObjMaterialBuilder {
  public:
    /// Appends images and warnings to `scene`; files are under `folder`.
    ObjMaterialBuilder(GltfScene& scene, std::string folder, const ObjLimits& limits);

    /// A roughness that gives highlights as wide as Phong's exponent does, unless the library has
    /// one. `subfolder`: of the library, in which its images are.
    [[nodiscard]] Material build(const ObjMaterial& source, const std::string& subfolder);

  private:
    /// Null: missing.
    const ImageData* load(const ObjMap& map);
    /// The index of an image of the scene; `key` says how it is made of which files.
    template <typename Make>
    std::uint32_t add_image(const std::string& key, Make&& make);
    std::uint32_t add_color_image(const ObjMap& map, const ImageData& image);

    void add_color(const ObjMaterial& source, Material& material);
    void add_relief(const ObjMaterial& source, Material& material);
    void add_roughness(const ObjMaterial& source, Material& material);

    GltfScene& scene_;
    std::string folder_;
    ObjLimits limits_;
    std::uint64_t pixels_left_;
    std::string subfolder_;                      ///< of the library that is built
    std::map<std::string, ImageData> loaded_;    ///< by path; without size where it failed
    std::map<std::string, std::uint32_t> made_;  ///< images of the scene by key
};

}  // namespace limn
