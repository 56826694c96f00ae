#include "bench/quality/quality.h"
#include "content/load/files/png_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace limn {
namespace {

const char* bound_name(QualityBound bound) {
    switch (bound) {
    case QualityBound::AtMost:
        return "at_most";
    case QualityBound::AtLeast:
        return "at_least";
    case QualityBound::None:
        return "none";
    }
    return "none";
}

std::string number_text(double value, const std::string& unit) {
    return unit.empty() ? fmt::format("{:.4g}", value) : fmt::format("{:.4g} {}", value, unit);
}

/// "<= 0.004", or nothing.
std::string limit_text(const QualityRow& row) {
    if (row.bound == QualityBound::None) {
        return "";
    }
    return fmt::format(
        "{} {}", row.bound == QualityBound::AtMost ? "<=" : ">=", number_text(row.limit, row.unit));
}

// ---- the page

constexpr const char* kStyle = R"(
body { background: #15171a; color: #d8dce2; font: 15px/1.5 system-ui, sans-serif; margin: 2rem auto; max-width: 1053px; }
h1, h2 { font-weight: 600; }
h2 { border-top: 1px solid #333a44; margin-top: 2.5rem; padding-top: 1rem; }
p { color: #98a2b0; }
table { border-collapse: collapse; margin: 1rem 0; width: 100%; }
th, td { border-bottom: 1px solid #262b32; padding: .3rem .8rem .3rem 0; text-align: left; }
em { color: #e8c98a; font-style: normal; } li { color: #98a2b0; }
summary { color: #98a2b0; cursor: pointer; }
td.number, th.number { font-variant-numeric: tabular-nums; text-align: right; }
.yes { color: #7fd494; } .no { color: #ff7b72; font-weight: 600; }
figure { margin: 1rem 0; } figcaption { color: #98a2b0; margin-bottom: .3rem; }
.row { display: flex; gap: .6rem; } .row div { flex: 1; } .row img { width: 100%; image-rendering: pixelated; }
small { color: #98a2b0; }
)";

/// RFC 4648.
std::string base64(std::span<const std::uint8_t> bytes) {
    constexpr const char* kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t left = std::min<std::size_t>(bytes.size() - i, 3);
        std::uint32_t word = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            word = word << 8 | (k < left ? bytes[i + k] : 0u);
        }
        for (std::size_t k = 0; k < 4; ++k) {
            text += k <= left ? kDigits[word >> (18 - 6 * k) & 63] : '=';
        }
    }
    return text;
}

std::string number_table(const QualityReport& report) {
    std::string html = "<table><tr><th>measured</th><th class=\"number\">found</th><th "
                       "class=\"number\">must be</th><th></th></tr>\n";
    for (const QualityRow& row : report.rows) {
        const char* verdict = row.bound == QualityBound::None ? "<td></td>"
                              : holds(row)                    ? "<td class=\"yes\">ok</td>"
                                                              : "<td class=\"no\">violated</td>";
        html += fmt::format(
            "<tr><td>{}</td><td class=\"number\">{}</td><td class=\"number\">{}</td>{}</tr>\n",
            escape_html(row.name), escape_html(number_text(row.found, row.unit)),
            escape_html(limit_text(row)), verdict);
    }
    return html + "</table>\n";
}

Result<std::string> figure(const QualityImage& image) {
    std::string html = fmt::format(
        "<figure><figcaption>{}</figcaption><div class=\"row\">\n", escape_html(image.title));
    const auto add = [&html](const ColorImage& shown, std::string_view caption) -> Status {
        const Result<std::string> tag = image_tag(shown, caption);
        if (!tag) {
            return tag.error();
        }
        html += *tag;
        return Done{};
    };
    Status status = add(image.effect, "effect");
    if (status && !image.oracle.pixels.empty()) {
        status = add(image.oracle, "oracle");
        if (status) {
            status =
                add(enhanced_difference(image.oracle, image.effect, 0.25f),
                    "difference, to the power 1/4");
        }
    }
    if (!status) {
        return status.error();
    }
    return html + "</div></figure>\n";
}

}  // namespace

std::string escape_html(std::string_view text) {
    std::string out;
    for (const char c : text) {
        switch (c) {
        case '&':
            out += "&amp;";
            break;
        case '<':
            out += "&lt;";
            break;
        case '>':
            out += "&gt;";
            break;
        case '"':
            out += "&quot;";
            break;
        default:
            out += c;
        }
    }
    return out;
}

Result<std::string> image_tag(const ColorImage& image, std::string_view caption) {
    std::vector<std::uint8_t> bytes;
    bytes.reserve(3 * image.pixels.size());
    for (const Vec3& pixel : image.pixels) {
        for (int c = 0; c < 3; ++c) {
            const float value = pixel[c] > 0.0f ? std::min(pixel[c], 1.0f) : 0.0f;
            bytes.push_back(static_cast<std::uint8_t>(std::lround(255.0f * value)));
        }
    }
    const auto png = png_bytes(image.width, image.height, 3, bytes);
    if (!png) {
        return png.error();
    }
    return fmt::format(
        "<div><img src=\"data:image/png;base64,{}\" alt=\"{}\"><small>{}</small></div>\n",
        base64(*png), caption, caption);
}

std::string quality_table(std::span<const MeasuredQuality> measured) {
    std::size_t width = 0;
    std::size_t numbers = 14;
    std::size_t limits = 14;
    for (const MeasuredQuality& one : measured) {
        for (const QualityRow& row : one.report.rows) {
            width = std::max(width, row.name.size());
            numbers = std::max(numbers, number_text(row.found, row.unit).size());
            limits = std::max(limits, limit_text(row).size());
        }
    }
    std::string text;
    for (const MeasuredQuality& one : measured) {
        text += fmt::format("{}: vs {}\n", one.effect->name, one.effect->oracle);
        for (const QualityRow& row : one.report.rows) {
            text += fmt::format(
                "  {:<{}}  {:>{}}  {:<{}}  {}\n", row.name, width, number_text(row.found, row.unit),
                numbers, limit_text(row), limits,
                row.bound == QualityBound::None ? ""
                : holds(row)                    ? "ok"
                                                : "VIOLATED");
        }
    }
    return text;
}

std::string quality_json(std::span<const MeasuredQuality> measured, std::string_view gl_renderer) {
    nlohmann::ordered_json effects = nlohmann::ordered_json::array();
    for (const MeasuredQuality& one : measured) {
        nlohmann::ordered_json rows = nlohmann::ordered_json::array();
        for (const QualityRow& row : one.report.rows) {
            nlohmann::ordered_json item = {{"name", row.name}, {"found", nullptr}};
            if (std::isfinite(row.found)) {
                item["found"] = row.found;
            }
            item["bound"] = bound_name(row.bound);
            item["limit"] = row.limit;
            item["unit"] = row.unit;
            item["holds"] = holds(row);
            rows.push_back(std::move(item));
        }
        effects.push_back(
            {{"name", one.effect->name},
             {"oracle", one.effect->oracle},
             {"rows", std::move(rows)}});
    }
    const nlohmann::ordered_json all = {{"gl", gl_renderer}, {"effects", std::move(effects)}};
    return all.dump(2) + "\n";
}

Result<std::string>
quality_html(std::span<const MeasuredQuality> measured, std::string_view gl_renderer) {
    std::string html = fmt::format(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Limn: "
        "quality</title>\n<style>{}</style></head><body>\n<h1>Limn: effects vs their "
        "oracles</h1>\n<p>Written by <code>limn quality --html</code>; rendered by {}.</p>\n",
        kStyle, escape_html(gl_renderer));
    for (const MeasuredQuality& one : measured) {
        html += fmt::format(
            "<h2 id=\"{0}\">{0}</h2>\n<p>Compared with {1}.</p>\n", escape_html(one.effect->name),
            escape_html(one.effect->oracle));
        const std::string numbers = number_table(one.report);
        if (one.report.html.empty()) {
            html += numbers;
        } else {  // sections that hold most of the numbers, too
            const bool all_hold =
                std::all_of(one.report.rows.begin(), one.report.rows.end(), holds);
            html += fmt::format(
                "<details{}><summary>All {} numbers, with their bounds</summary>\n{}</details>\n",
                all_hold ? "" : " open", one.report.rows.size(), numbers);
        }
        for (const QualityImage& image : one.report.images) {
            const Result<std::string> tag = figure(image);
            if (!tag) {
                return tag.error();
            }
            html += *tag;
        }
        html += one.report.html;
    }
    return html + "</body></html>\n";
}

}  // namespace limn
