#include "content/load/faces/makehuman_files.h"

#include "content/load/files/json_document.h"
#include "ecs/base/text.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace limn {

namespace {

constexpr double kLargest = 1000;  ///< [dm]
constexpr std::string_view kMakehumanSpaces = " \t\r\v\f";

/// Words of the lines of a text that are neither empty nor comments.
class WordReader {
  public:
    WordReader(std::string_view text, const std::string& file) : text_(text), file_(file) {}

    /// False at the end of the text.
    bool next_line() {
        while (at_ < text_.size()) {
            const std::size_t end = std::min(text_.find('\n', at_), text_.size());
            rest_ = text_.substr(at_, end - at_);
            at_ = end + 1;
            ++line_;
            skip_spaces();
            if (!rest_.empty() && rest_.front() != '#') {
                return true;
            }
        }
        return false;
    }

    std::string_view word() {
        skip_spaces();
        const std::string_view found = rest_.substr(0, rest_.find_first_of(kMakehumanSpaces));
        rest_.remove_prefix(found.size());
        return found;
    }

    [[nodiscard]] bool starts_with_digit() const {
        return !rest_.empty() && rest_.front() >= '0' && rest_.front() <= '9';
    }

    Result<std::uint32_t> index(std::size_t vertices) {
        const std::string_view found = word();
        std::uint32_t value = 0;
        const auto [stop, code] = std::from_chars(found.data(), found.data() + found.size(), value);
        if (found.empty() || stop != found.data() + found.size() || code != std::errc{}
            || value >= vertices) {
            return fail(
                "{}:{}: found {}, expected a vertex below {}", file_, line_, in_quotes(found),
                vertices);
        }
        return value;
    }

    Result<float> number() {
        const std::string_view found = word();
        double value = 0;
        const auto [stop, code] = std::from_chars(found.data(), found.data() + found.size(), value);
        if (found.empty() || stop != found.data() + found.size() || code != std::errc{}
            || !(std::abs(value) <= kLargest)) {
            return fail(
                "{}:{}: found {}, expected a number of at most {}", file_, line_, in_quotes(found),
                kLargest);
        }
        return static_cast<float>(value);
    }

    Result<Vec3> vector() {
        Vec3 value;
        for (int i = 0; i < 3; ++i) {
            value[i] = LIMN_TRY(number());
        }
        return value;
    }

  private:
    void skip_spaces() {
        rest_.remove_prefix(std::min(rest_.find_first_not_of(kMakehumanSpaces), rest_.size()));
    }

    std::string_view text_;
    const std::string& file_;
    std::size_t at_ = 0;
    std::size_t line_ = 0;
    std::string_view rest_;
};

Vec3 blend(const MakehumanFit& fit, std::span<const Vec3> values) {
    Vec3 sum = Vec3(0);
    for (int i = 0; i < 3; ++i) {
        sum += fit.weights[i] * values[fit.vertices[static_cast<std::size_t>(i)]];
    }
    return sum;
}

}  // namespace

Result<std::vector<MakehumanOffset>>
parse_makehuman_target(std::string_view text, const std::string& file, std::size_t vertices) {
    std::vector<MakehumanOffset> offsets;
    WordReader reader(text, file);
    while (reader.next_line()) {
        const std::uint32_t vertex = LIMN_TRY(reader.index(vertices));
        offsets.push_back({vertex, LIMN_TRY(reader.vector())});
    }
    return offsets;
}

Result<MakehumanProxy>
parse_makehuman_proxy(std::string_view text, const std::string& file, std::size_t vertices) {
    MakehumanProxy proxy;
    WordReader reader(text, file);
    while (reader.next_line()) {
        if (reader.starts_with_digit()) {
            MakehumanFit fit;
            for (std::uint32_t& vertex : fit.vertices) {
                vertex = LIMN_TRY(reader.index(vertices));
            }
            fit.weights = LIMN_TRY(reader.vector());
            fit.offset = LIMN_TRY(reader.vector());
            proxy.fits.push_back(fit);
            continue;
        }
        const std::string_view keyword = reader.word();
        constexpr std::string_view kScales[] = {"x_scale", "y_scale", "z_scale"};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (keyword == kScales[axis]) {
                MakehumanProxy::Scale& scale = proxy.scales[axis];
                scale.vertices[0] = LIMN_TRY(reader.index(vertices));
                scale.vertices[1] = LIMN_TRY(reader.index(vertices));
                scale.distance = LIMN_TRY(reader.number());
            }
        }
    }
    if (proxy.fits.empty()) {
        return fail("{}: found no vertices, expected lines of three indices and six numbers", file);
    }
    return proxy;
}

std::vector<Vec3> fit_proxy(const MakehumanProxy& proxy, std::span<const Vec3> positions) {
    Vec3 scale = Vec3(1);
    for (int axis = 0; axis < 3; ++axis) {
        const auto& [ends, distance] = proxy.scales[static_cast<std::size_t>(axis)];
        const float now = std::abs(positions[ends[0]][axis] - positions[ends[1]][axis]);
        scale[axis] = ends[0] != ends[1] && distance > 0 ? now / distance : 1.0f;
    }
    std::vector<Vec3> fitted;
    for (const MakehumanFit& fit : proxy.fits) {
        fitted.push_back(blend(fit, positions) + scale * fit.offset);
    }
    return fitted;
}

std::vector<Vec3> fit_offsets(const MakehumanProxy& proxy, std::span<const Vec3> offsets) {
    std::vector<Vec3> fitted;
    for (const MakehumanFit& fit : proxy.fits) {
        fitted.push_back(blend(fit, offsets));
    }
    return fitted;
}

}  // namespace limn
