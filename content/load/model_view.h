#pragma once

#include "content/load/load_warnings.h"
#include "ecs/base/math.h"
#include "ecs/base/result.h"
#include "ecs/components/surface.h"
#include "ecs/entity.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace limn {

class World;

// What a glTF file by itself gets to be looked at: a camera that frames it, a studio with a ground
// or another backdrop, lights if it has none that reach it, and an exposure for the light that it
// has, as a photographer's incident light meter would give: files come without lights, with lights
// in arbitrary units, or with a sun of 100,000 lux.

struct ModelViewOptions {
    std::string backdrop = "studio";  ///< studio, sky, gray, black, or an image: a panorama
    double turntable = 0;             ///< seconds per turn of the camera; 0: it stands still
    std::string variant = {};         ///< of the materials of a glTF file; empty: its default
    LoadOptions load = {};            ///< what a bad part of the file costs
};

/// What is behind a model and lights it.
struct Backdrop {
    std::string name;
    std::optional<ImageData> panorama = {};
};

/// Fails where `name` is neither a backdrop nor a readable image.
[[nodiscard]] Result<Backdrop> load_backdrop(const std::string& name);

struct ModelView {
    Entity camera;
    Bounds subject;             ///< what is framed: without a ground plane or sky dome of the file
    std::vector<Entity> added;  ///< every entity that is not the file's
    std::size_t meshes = 0;     ///< added at the end of those of Assets
    std::size_t materials = 0;  ///< likewise
};

/// Sets up the view of everything in `world`, which has the resource Assets. Inserts Environment
/// and Exposure; leaves cameras and lights of the file as they are, but for shadows of its
/// strongest lights. `turntable`: seconds per turn of the camera; 0: it stands still.
[[nodiscard]] ModelView add_model_view(World& world, Backdrop backdrop, double turntable = 0);

/// Illuminance [lx] of surfaces that face the lights of the scene, averaged over points within
/// `subject`; 0 where no light reaches it. Needs no step of the simulation.
[[nodiscard]] float find_illuminance(World& world, const Bounds& subject);

}  // namespace limn
