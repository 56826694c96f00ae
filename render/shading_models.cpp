#include "render/shading_models.h"

#include "render/variant.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <span>
#include <string_view>
#include <vector>

namespace limn {
namespace {

constexpr bool rows_are_in_order() {
    for (std::size_t i = 0; i < std::size(kShadingModels); ++i) {
        if (static_cast<std::size_t>(kShadingModels[i].model) != i) {
            return false;
        }
    }
    return true;
}
static_assert(rows_are_in_order());

constexpr const ShadingModelRow& kBase = kShadingModels[0];
constexpr std::span kOthers = std::span(kShadingModels).subspan(1);

bool contains(ShadingModelSet models, const ShadingModelRow& row) {
    return (models >> stored_number(row.model) & 1u) != 0;
}

/// Runs `statement` where `model`, a stored number, is that of one of `rows`.
std::string where_model(
    std::span<const ShadingModelRow> rows, std::string_view model, const std::string& statement) {
    std::string defined;
    std::string equal;
    for (const ShadingModelRow& row : rows) {
        const char* or_else = defined.empty() ? "" : " || ";
        defined += fmt::format("{}defined({})", or_else, row.definition);
        equal += fmt::format("{}{} == {}", or_else, model, row.number);
    }
    return fmt::format(
        "#if {}\n    if ({}) {{\n        {}\n    }}\n#endif\n", defined, equal, statement);
}

/// The rows other than the base's, by a lobe other than the base's.
std::map<std::string_view, std::vector<ShadingModelRow>> rows_by_lobe() {
    std::map<std::string_view, std::vector<ShadingModelRow>> rows;
    for (const ShadingModelRow& row : kOthers) {
        if (std::string_view(row.lobe) != kBase.lobe) {
            rows[row.lobe].push_back(row);
        }
    }
    return rows;
}

}  // namespace

bool reads_material_records(ShadingModelSet models) {
    return std::any_of(
        std::begin(kShadingModels), std::end(kShadingModels),
        [models](const ShadingModelRow& row) { return row.reads_record && contains(models, row); });
}

void add_shading_models(Variant& variant, ShadingModelSet models) {
    for (const ShadingModelRow& row : kOthers) {
        variant.add_if(contains(models, row), row.definition);
    }
    variant.add_if(reads_material_records(models), "MATERIAL_RECORDS");
}

std::string model_numbers_glsl() {
    std::string text = "const uint kModelNone = 0u;\n";
    for (const ShadingModelRow& row : kShadingModels) {
        text += fmt::format("const uint {} = {}u;\n", row.number, stored_number(row.model));
    }
    return text;
}

std::string model_functions_glsl() {
    std::string text;
    for (const ShadingModelRow& row : kShadingModels) {
        text += fmt::format("#include \"shade_{}.glsl\"\n", row.name);
    }
    text += fmt::format(
        "\nvoid prepare_model(inout Reflector r, SurfaceSample s) {{\n    prepare_{}(r, s);\n",
        kBase.name);
    for (const ShadingModelRow& row : kOthers) {
        text += where_model({&row, 1}, "s.model", fmt::format("prepare_{}(r, s);", row.name));
    }
    text += fmt::format(
        "}}\n\nResponse model_response(Reflector r, Cosines c) {{\n"
        "    Response response = lobe_{}(r, c);\n",
        kBase.lobe);
    for (const auto& [lobe, rows] : rows_by_lobe()) {
        text += where_model(rows, "r.model", fmt::format("response = lobe_{}(r, c);", lobe));
    }
    return text + "    return response;\n}\n";
}

}  // namespace limn
