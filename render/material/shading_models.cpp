#include "render/material/shading_models.h"

#include "render/variant.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <span>
#include <string_view>
#include <vector>

// Techniques: char.skin-shade

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
constexpr auto kAllRows = [] {
    std::array<ShadingModelRow, std::size(kShadingModels) + 1> rows = {};
    std::copy(std::begin(kShadingModels), std::end(kShadingModels), rows.begin());
    rows.back() = kLayeredRow;
    return rows;
}();
constexpr std::span kOthers = std::span(kAllRows).subspan(1);

bool contains(ShadingModelSet models, const ShadingModelRow& row) {
    return (models >> stored_number(row.model) & 1u) != 0;
}

/// describe(row) of each, joined by "||".
std::string any_of_rows(std::span<const ShadingModelRow> rows, auto&& describe) {
    std::string all;
    for (const ShadingModelRow& row : rows) {
        all += (all.empty() ? "" : " || ") + describe(row);
    }
    return all;
}

std::string is_defined(std::span<const ShadingModelRow> rows) {
    return any_of_rows(rows, [](const ShadingModelRow& row) {
        return fmt::format("defined({})", row.definition);
    });
}

/// Whether `model`, a stored number, is that of one of `rows`.
std::string is_model(std::span<const ShadingModelRow> rows, std::string_view model) {
    return any_of_rows(rows, [model](const ShadingModelRow& row) {
        return fmt::format("{} == {}", model, row.number);
    });
}

std::string prepare_where(const ShadingModelRow& row) {
    return fmt::format(
        "#if defined({}) && (!defined(SHADING_LOBE) || SHADING_LOBE == {})\n"
        "    if ({}) {{\n        prepare_{}(r, s);\n    }}\n#endif\n",
        row.definition, lobe_number(row.model), is_model({&row, 1}, "s.model"), row.name);
}

/// Replaces the response of the base lobe by that of `lobe`, which `rows` have.
std::string respond_where(std::string_view lobe, std::span<const ShadingModelRow> rows) {
    return fmt::format(
        "#if defined(SHADING_LOBE) && SHADING_LOBE == {0}\n    response = lobe_{1}(r, c);\n"
        "#elif !defined(SHADING_LOBE) && ({2})\n"
        "    if ({3}) {{\n        response = lobe_{1}(r, c);\n    }}\n#endif\n",
        lobe_number(rows[0].model), lobe, is_defined(rows), is_model(rows, "r.model"));
}

/// The rows that do not use the base lobe, by their lobe.
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

ShadingModelSet lobes_of(ShadingModelSet models) {
    ShadingModelSet lobes = 0;
    for (const ShadingModelRow& row : kAllRows) {
        lobes |= contains(models, row) ? 1u << lobe_number(row.model) : 0u;
    }
    return lobes;
}

bool reads_material_records(ShadingModelSet models) {
    return std::any_of(kAllRows.begin(), kAllRows.end(), [models](const ShadingModelRow& row) {
        return row.reads_record && contains(models, row);
    });
}

void add_shading_models(Variant& variant, ShadingModelSet models) {
    for (const ShadingModelRow& row : kOthers) {
        variant.add_if(contains(models, row), row.definition);
    }
    variant.add_if(reads_material_records(models), "MATERIAL_RECORDS");
}

std::string model_numbers_glsl() {
    std::string text = "const uint kModelNone = 0u;\n";
    for (const ShadingModelRow& row : kAllRows) {
        text += fmt::format("const uint {} = {}u;\n", row.number, stored_number(row.model));
    }
    text += "uint lobe_number(uint model) {\n    uint number = model;\n";
    for (const ShadingModelRow& row : kAllRows) {
        if (lobe_number(row.model) != stored_number(row.model)) {
            text += fmt::format(
                "    number = model == {} ? {}u : number;\n", row.number, lobe_number(row.model));
        }
    }
    text += "    return number;\n}\n";
    return text
           + fmt::format(
               "#ifdef ON_WATER\n#undef SHADE_LAYERED\n#endif\n"
               "#if defined(LAYERED_SURFACE) || (defined(SHADE_LAYERED) "
               "&& (!defined(SHADING_LOBE) || SHADING_LOBE == {}))\n#define LAYERED\n#endif\n",
               lobe_number(kLayeredModel));
}

std::string model_functions_glsl() {
    std::string text;
    for (const ShadingModelRow& row : kAllRows) {
        text += fmt::format("#include \"shade_{}.glsl\"\n", row.name);
    }
    text += fmt::format(
        "\nvoid prepare_model(inout Reflector r, SurfaceSample s) {{\n    prepare_{}(r, s);\n",
        kBase.name);
    for (const ShadingModelRow& row : kOthers) {
        text += prepare_where(row);
    }
    text += fmt::format(
        "}}\n\nResponse model_response(Reflector r, Cosines c) {{\n"
        "    Response response = lobe_{}(r, c);\n",
        kBase.lobe);
    for (const auto& [lobe, rows] : rows_by_lobe()) {
        text += respond_where(lobe, rows);
    }
    return text + "    return response;\n}\n";
}

}  // namespace limn
