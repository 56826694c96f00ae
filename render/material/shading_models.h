#pragma once

#include "ecs/components/surface.h"

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string>
#include <string_view>

namespace limn {

class Variant;

// The shading models that surfaces are lit with. A model is a value of ShadingModel, a row here and
// a file render/shaders/shade_<name>.glsl; lib/reflector.glsl says what the file contains. The rows
// generate the numbers in the G-buffer, the definitions of lit programs, and the GLSL that calls
// the functions of each model. A program calls only the models that some material of the level has.

struct ShadingModelRow {
    ShadingModel model;
    const char* name;           ///< of the file and its prepare function
    const char* number;         ///< constant of the stored number
    const char* definition;     ///< set if some material has the model; null: every program has it
    const char* lobe = "pbr";   ///< of the function lobe_<lobe>
    bool reads_record = false;  ///< its functions read the material's record
};

/// In the order of ShadingModel.
inline constexpr ShadingModelRow kShadingModels[] = {
    {ShadingModel::Pbr, "pbr", "kModelPbr", nullptr},
    {ShadingModel::Blinn, "blinn", "kModelBlinn", "SHADE_BLINN", "classic", true},
    {ShadingModel::Phong, "phong", "kModelPhong", "SHADE_PHONG", "classic", true},
    {ShadingModel::Unlit, "unlit", "kModelUnlit", "SHADE_UNLIT"},
    {ShadingModel::Skin, "skin", "kModelSkin", "SHADE_SKIN", "classic", true},
    {ShadingModel::Lafortune, "lafortune", "kModelLafortune", "SHADE_LAFORTUNE", "lafortune", true},
    {ShadingModel::Subsurface, "subsurface", "kModelSubsurface", "SHADE_SUBSURFACE", "subsurface",
     true},
    {ShadingModel::Hair, "hair", "kModelHair", "SHADE_HAIR", "hair", true},
    {ShadingModel::Toon, "toon", "kModelToon", "SHADE_TOON", "toon", true},
    {ShadingModel::Strand, "strand", "kModelStrand", "SHADE_STRAND", "strand", true},
};
inline constexpr std::size_t kMaxShadingModels = 16;  ///< four bits in the G-buffer
static_assert(std::size(kShadingModels) < kMaxShadingModels - 1, "0 is no surface");

/// Pbr with layers (material_layers.h), which no material names: the last number.
inline constexpr auto kLayeredModel = static_cast<ShadingModel>(kMaxShadingModels - 2);
inline constexpr ShadingModelRow kLayeredRow = {kLayeredModel,   "layered", "kModelLayered",
                                                "SHADE_LAYERED", "layered", true};

/// The number in the G-buffer; 0 is no surface.
[[nodiscard]] constexpr std::uint32_t stored_number(ShadingModel model) {
    return static_cast<std::uint32_t>(model) + 1;
}

/// The stored number of the first model with the same lobe.
[[nodiscard]] constexpr std::uint32_t lobe_number(ShadingModel model) {
    if (model == kLayeredModel) {
        return stored_number(model);
    }
    const std::string_view lobe = kShadingModels[static_cast<std::size_t>(model)].lobe;
    std::size_t first = 0;
    while (std::string_view(kShadingModels[first].lobe) != lobe) {
        ++first;
    }
    return stored_number(kShadingModels[first].model);
}

/// A set of models: bit n is the one stored as n.
using ShadingModelSet = std::uint32_t;

/// The lobes of models: bit n is the one with lobe_number() n.
[[nodiscard]] ShadingModelSet lobes_of(ShadingModelSet models);

/// Whether lighting passes need the material of each pixel.
[[nodiscard]] bool reads_material_records(ShadingModelSet models);

/// Adds the definitions of lit programs: those of the models, and MATERIAL_RECORDS.
void add_shading_models(Variant& variant, ShadingModelSet models);

/// GLSL: the constants of the stored numbers; lobe_number().
[[nodiscard]] std::string model_numbers_glsl();
/// GLSL: the files of all models; prepare_model() and model_response(), which choose among them, or
/// with SHADING_LOBE, a lobe_number(), among those with this lobe.
[[nodiscard]] std::string model_functions_glsl();

}  // namespace limn
