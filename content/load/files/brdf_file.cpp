#include "content/load/files/brdf_file.h"

#include "content/load/files/json_document.h"
#include "ecs/base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <optional>
#include <system_error>

// Techniques: skin.brdf-lafortune

namespace limn {
namespace {

constexpr std::string_view kBrdfSpaces = " \t\r\v\f";
constexpr int kChannels = 3;

/// Takes the next word off `line`; "" at its end.
std::string_view take_word(std::string_view& line) {
    line.remove_prefix(std::min(line.find_first_not_of(kBrdfSpaces), line.size()));
    const std::string_view word = line.substr(0, line.find_first_of(kBrdfSpaces));
    line.remove_prefix(word.size());
    return word;
}

/// The rest of the line as N numbers, the n-th between least[n] and most[n].
template <std::size_t N>
std::optional<std::array<float, N>> take_numbers(
    std::string_view line, const std::array<float, N>& least, const std::array<float, N>& most) {
    std::array<float, N> numbers;
    for (std::size_t i = 0; i < N; ++i) {
        const std::string_view word = take_word(line);
        const auto [end, error] =
            std::from_chars(word.data(), word.data() + word.size(), numbers[i]);
        const bool whole = error == std::errc() && end == word.data() + word.size();
        if (!whole || !(numbers[i] >= least[i] && numbers[i] <= most[i])) {
            return std::nullopt;
        }
    }
    return take_word(line).empty() ? std::optional(numbers) : std::nullopt;
}

}  // namespace

Result<BrdfFit> parse_brdf(std::string_view text, const std::string& file) {
    BrdfFit fit;
    int channel = -1;
    std::size_t lobes = 0;  // of the channel
    for (int number = 1; !text.empty(); ++number) {
        const std::string_view whole = text.substr(0, text.find('\n'));
        text.remove_prefix(std::min(whole.size() + 1, text.size()));
        std::string_view line = whole.substr(0, whole.find('#'));
        const auto unexpected = [&](std::string_view expected) {
            return fail(
                "{}:{}: found {}, expected {}", file, number, in_quotes(whole.substr(0, 60)),
                expected);
        };
        const std::string_view word = take_word(line);
        if (word.empty()) {
            continue;
        }
        if (word == "channel") {
            const auto diffuse = take_numbers<1>(line, {0}, {1});
            if (!diffuse) {
                return unexpected("\"channel\" and a number, 0 to 1");
            }
            if (++channel == kChannels) {
                return unexpected("the end of the file: red, green and blue were given");
            }
            fit.diffuse[channel] = (*diffuse)[0];
            lobes = 0;
        } else if (word == "lobe") {
            const auto lobe = take_numbers<3>(line, {-2, -2, 0}, {2, 2, 10000});
            if (!lobe) {
                return unexpected(
                    "\"lobe\" and three numbers: Cxy and Cz, -2 to 2, and an exponent, 0 to 10000");
            }
            if (channel < 0) {
                return unexpected("\"channel\" before its lobes");
            }
            if (++lobes > kMaxLafortuneLobes) {
                return unexpected(fmt::format("at most {} lobes a channel", kMaxLafortuneLobes));
            }
            if (lobes > fit.lobes.size()) {
                fit.lobes.push_back({.across = Vec3(0), .along = Vec3(0), .exponent = Vec3(1)});
            }
            fit.lobes[lobes - 1].across[channel] = (*lobe)[0];
            fit.lobes[lobes - 1].along[channel] = (*lobe)[1];
            fit.lobes[lobes - 1].exponent[channel] = (*lobe)[2];
        } else {
            return unexpected("a line that begins with \"channel\" or \"lobe\"");
        }
    }
    if (channel + 1 != kChannels) {
        return fail("{}: found {} channels, expected red, green and blue", file, channel + 1);
    }
    return fit;
}

}  // namespace limn
