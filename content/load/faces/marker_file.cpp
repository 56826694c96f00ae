#include "content/load/faces/marker_file.h"

#include "content/load/files/atomic_file.h"
#include "content/load/files/json_document.h"
#include "ecs/base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <vector>

// Techniques: face.mocap-drive

namespace limn {
namespace {

constexpr float kLargestMarkerFile = 1e6f;                    ///< coordinate [m]
constexpr std::size_t kFirstColumns = 2;                      ///< frame and time
constexpr std::string_view kMarkerFileMark = "\xef\xbb\xbf";  ///< UTF-8, as some editors write it

/// Lines of a text, as cells between tabs without spaces around.
class TabReader {
  public:
    explicit TabReader(std::string_view text)
        : text_(text.starts_with(kMarkerFileMark) ? text.substr(kMarkerFileMark.size()) : text) {}

    bool next(std::vector<std::string_view>& cells) {
        cells.clear();
        if (text_.empty()) {
            return false;
        }
        ++number_;
        const std::size_t end = text_.find('\n');
        std::string_view line = text_.substr(0, end);
        text_.remove_prefix(end == std::string_view::npos ? text_.size() : end + 1);
        while (true) {
            const std::size_t tab = line.find('\t');
            cells.push_back(trim(line.substr(0, tab)));
            if (tab == std::string_view::npos) {
                return true;
            }
            line.remove_prefix(tab + 1);
        }
    }
    [[nodiscard]] std::size_t number() const { return number_; }

  private:
    static std::string_view trim(std::string_view cell) {
        const std::size_t first = cell.find_first_not_of(" \r");
        return first == std::string_view::npos
                   ? std::string_view{}
                   : cell.substr(first, cell.find_last_not_of(" \r") - first + 1);
    }

    std::string_view text_;
    std::size_t number_ = 0;
};

bool read_number(std::string_view cell, float& number) {
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), number);
    return error == std::errc{} && end == cell.data() + cell.size() && std::isfinite(number);
}

float meters_of(std::string_view unit) {
    return unit == "mm" || unit == "MM"   ? 1e-3f
           : unit == "cm" || unit == "CM" ? 1e-2f
           : unit == "m" || unit == "M"   ? 1.0f
                                          : 0.0f;
}

/// Removes the name of the subject that Vicon writes before each marker, "Anna:Chin", if it is
/// before all of them.
void remove_subject(std::vector<std::string>& names) {
    const std::string subject = names[0].substr(0, names[0].find(':') + 1);
    const auto has_subject = [&](const std::string& name) {
        return name.starts_with(subject) && name.size() > subject.size();
    };
    if (!subject.empty() && std::ranges::all_of(names, has_subject)) {
        for (std::string& name : names) {
            name.erase(0, subject.size());
        }
    }
}

class TrcParser {
  public:
    TrcParser(std::string_view text, const std::string& file, const MarkerLimits& limits)
        : lines_(text), file_(file), limits_(limits) {}

    Result<MarkerMotion> parse() {
        LIMN_TRY(read_head());
        LIMN_TRY(read_names());
        lines_.next(cells_);  // X1 Y1 Z1 ...
        while (lines_.next(cells_)) {
            if (cells_.size() > 1 || !cells_[0].empty()) {
                LIMN_TRY(read_frame());
            }
        }
        if (motion_.positions.empty()) {
            return fail("{}: found no frames", file_);
        }
        return std::move(motion_);
    }

  private:
    [[nodiscard]] std::string here() const { return fmt::format("{}:{}", file_, lines_.number()); }

    Status read_head() {
        if (!lines_.next(cells_) || cells_[0] != "PathFileType") {
            return fail("{}: found no TRC file, expected one that begins with PathFileType", file_);
        }
        std::vector<std::string_view> keys;
        lines_.next(keys);
        lines_.next(cells_);
        for (std::size_t i = 0; i < std::min(keys.size(), cells_.size()); ++i) {
            if (keys[i] == "DataRate"
                && (!read_number(cells_[i], motion_.rate) || !(motion_.rate > 0.0f)
                    || motion_.rate > 1e5f)) {
                return fail(
                    "{}: found the rate {}, expected 0 to 100000 frames per second", here(),
                    in_quotes(cells_[i]));
            }
            if (keys[i] == "Units") {
                meters_ = meters_of(cells_[i]);
                if (meters_ == 0.0f) {
                    return fail(
                        "{}: found the unit {}, expected mm, cm or m", here(),
                        in_quotes(cells_[i]));
                }
            }
        }
        return Done{};
    }

    /// One name in three columns.
    Status read_names() {
        lines_.next(cells_);
        for (std::size_t i = kFirstColumns; i < cells_.size(); i += 3) {
            if (cells_[i].empty()) {
                break;
            }
            motion_.names.emplace_back(cells_[i]);
        }
        if (motion_.names.empty() || motion_.names.size() > limits_.max_markers) {
            return fail(
                "{}: found {} markers, expected 1 to {}", here(), motion_.names.size(),
                limits_.max_markers);
        }
        remove_subject(motion_.names);
        return Done{};
    }

    Status read_frame() {
        if (motion_.positions.size() + motion_.markers() > limits_.max_positions) {
            return fail("{}: found more than {} positions", here(), limits_.max_positions);
        }
        for (std::size_t m = 0; m < motion_.markers(); ++m) {
            Vec3 p(0);
            bool visible = true;
            for (int k = 0; k < 3; ++k) {
                const std::size_t column = kFirstColumns + 3 * m + static_cast<std::size_t>(k);
                const std::string_view cell =
                    column < cells_.size() ? cells_[column] : std::string_view{};
                visible = visible && !cell.empty();
                if (!cell.empty()
                    && (!read_number(cell, p[k])
                        || std::abs(p[k]) * meters_ > kLargestMarkerFile)) {
                    return fail(
                        "{}: found {} at the marker {}, expected a number", here(), in_quotes(cell),
                        in_quotes(motion_.names[m]));
                }
            }
            motion_.positions.push_back(
                visible ? meters_ * p : Vec3(std::numeric_limits<float>::quiet_NaN()));
        }
        return Done{};
    }

    TabReader lines_;
    const std::string& file_;
    const MarkerLimits& limits_;
    std::vector<std::string_view> cells_;
    MarkerMotion motion_;
    float meters_ = 1.0f;
};

}  // namespace

Result<MarkerMotion>
parse_trc(std::string_view text, const std::string& file, const MarkerLimits& limits) {
    return TrcParser(text, file, limits).parse();
}

Result<MarkerMotion> load_trc(const std::string& path) {
    const auto bytes = LIMN_TRY(read_file(path));
    return parse_trc({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path);
}

}  // namespace limn
