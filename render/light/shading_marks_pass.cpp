#include "render/light/shading_marks_pass.h"

#include "ecs/components/rendering.h"
#include "ecs/components/shading_comparison.h"
#include "ecs/components/wrinkle_comparison.h"
#include "ecs/field_access.h"
#include "ecs/world.h"
#include "render/fullscreen.h"
#include "render/light/lighting.h"
#include "render/settings.h"
#include "render/shaders/fullscreen_gpu.h"
#include "render/shaders/shading_comparison_gpu.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

// Techniques: fakephong.metric-scanline, wrinkle.comparison

namespace limn {
namespace {

constexpr std::size_t kMaxLabel = 48;        ///< glyphs
constexpr std::size_t kMaxColumnLabel = 12;  ///< of a column

/// Layout of shading_marks.frag: a float holds three glyphs exactly.
struct Label {
    Mat4 glyphs = Mat4(0);
    int length = 0;
};
Label make_label(std::string_view text) {
    constexpr int kDash = 26;
    constexpr int kBlank = 255;
    Label label{.length = static_cast<int>(std::min(text.size(), kMaxLabel))};
    for (int i = 0; i < label.length; ++i) {
        const char c = text[static_cast<std::size_t>(i)];
        const int glyph = c >= 'a' && c <= 'z' ? c - 'a' : c == '-' ? kDash : kBlank;
        label.glyphs[i / 12][i / 3 % 4] += static_cast<float>(glyph << 8 * (i % 3));
    }
    return label;
}

/// "blinn map"
std::string rate_name(ShadingRate rate) {
    const FieldInfo* const field = find_field(component_info<ShadingComparison>().fields, "right");
    std::string name(get_enum(*field, &rate));
    std::replace(name.begin(), name.end(), '_', ' ');
    return name;
}

/// The methods left and right of the divider; of a difference, both in the first.
std::array<Label, 2> make_labels(const World& world, const ShadingComparison& comparison) {
    const auto* rendering = world.find_resource<Rendering>();
    const std::string left = rate_name(rendering != nullptr ? rendering->shading : ShadingRate{});
    const std::string right = rate_name(comparison.right);
    if (comparison.image == ComparisonImage::Difference) {
        return {make_label(fmt::format("{} - {}", left, right)), {}};
    }
    return {make_label(left), make_label(right)};
}

/// The names of columns, one per column of the matrices.
struct ColumnLabels {
    Mat4 low = Mat4(0);
    Mat4 high = Mat4(0);
    Vec4 low_lengths = Vec4(0);
    Vec4 high_lengths = Vec4(0);
    int count = 0;
};

ColumnLabels make_column_labels(const std::vector<WrinkleMethod>& methods) {
    const FieldInfo* const field =
        find_field(component_info<WrinkleComparison>().fields, "methods");
    ColumnLabels labels;
    for (const WrinkleMethod method : methods) {
        const std::string_view name = field->values[static_cast<std::size_t>(method)];
        const Label label = make_label(name.substr(0, kMaxColumnLabel));
        const int at = labels.count % 4;
        (labels.count < 4 ? labels.low : labels.high)[at] = label.glyphs[0];
        (labels.count < 4 ? labels.low_lengths : labels.high_lengths)[at] =
            static_cast<float>(label.length);
        ++labels.count;
    }
    return labels;
}

std::vector<WrinkleMethod> shown_columns(const World& world) {
    return wrinkle_columns(world.find_resource<WrinkleComparison>());
}

}  // namespace

bool ShadingMarksEffect::is_used(const FrameData& frame) {
    return frame.world->find_resource<ScanlinePlot>() != nullptr
           || frame.world->find_resource<ShadingComparison>() != nullptr
           || !shown_columns(*frame.world).empty();
}

Result<ShadingMarksEffect> ShadingMarksEffect::create(gpu::Device& device, const RenderSettings&) {
    return ShadingMarksEffect{LIMN_TRY(load_fullscreen(device, "shading_marks.frag"))};
}

void ShadingMarksEffect::draw(FrameGraph& graph, const FrameData& frame, ViewData& view) {
    const auto* plot = frame.world->find_resource<ScanlinePlot>();
    const auto* comparison = frame.world->find_resource<ShadingComparison>();
    const auto* both = view.data.find<ComparedRadiance>();
    const TextureId left = both != nullptr ? both->left : view.radiance;
    const TextureId right = both != nullptr ? both->right : view.radiance;
    const TextureId marked = create_like(graph, "radiance with marks", view.radiance);
    add_fullscreen_pass(
        graph, "shading marks",
        {sampled(view.radiance, layout::kSourceUnit), sampled(left, layout::kLeftRadianceUnit),
         sampled(right, layout::kRightRadianceUnit)},
        {discarded(marked)}, program,
        [plotted = within_ranges(plot != nullptr ? *plot : ScanlinePlot{.height = 0}),
         divider = comparison != nullptr && comparison->image == ComparisonImage::Split
                       ? within_ranges(*comparison).divider
                       : -1,
         labels = comparison != nullptr ? make_labels(*frame.world, *comparison)
                                        : std::array<Label, 2>{},
         columns = make_column_labels(shown_columns(*frame.world)),
         borders = column_borders(frame.world->find_resource<WrinkleComparison>()),
         curves = both != nullptr ? 2 : 1](PassContext&, const gpu::Program& to) {
            to.set("left_label", labels[0].glyphs);
            to.set("right_label", labels[1].glyphs);
            to.set("label_lengths", IVec2(labels[0].length, labels[1].length));
            to.set("columns", columns.count);
            to.set("column_borders", borders);
            to.set("column_labels_low", columns.low);
            to.set("column_labels_high", columns.high);
            to.set("column_lengths_low", columns.low_lengths);
            to.set("column_lengths_high", columns.high_lengths);
            to.set("row", plotted.row);
            to.set("plot_height", plotted.height);
            to.set("divider", divider);
            to.set("curves", curves);
        });
    view.radiance = marked;
}

}  // namespace limn
