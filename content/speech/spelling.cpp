#include "content/speech/spelling.h"

#include "content/speech/phonemes.h"
#include "content/speech/spelling_rules.h"
#include "ecs/base/check.h"

#include <algorithm>
#include <array>
#include <string>

// Techniques: face.talking-head

namespace limn {

namespace {

constexpr std::string_view kStress = "ˈ";
constexpr std::string_view kSecondStress = "ˌ";

bool is_letter(char c) {
    return c >= 'a' && c <= 'z';
}

bool is_vowel(char c) {
    return std::string_view("aeiouy").find(c) != std::string_view::npos;
}

bool is_consonant(char c) {
    return is_letter(c) && !is_vowel(c);
}

/// Whether `word`, with a space at either edge, continues like `pattern` from `at` in direction
/// `step`, 1 or -1. Patterns to the left are read backward.
bool matches(std::string_view pattern, std::string_view word, std::ptrdiff_t at, int step) {
    const auto letter = [&](std::ptrdiff_t i) {
        return i >= 0 && i < std::ssize(word) ? word[static_cast<std::size_t>(i)] : ' ';
    };
    for (std::size_t i = 0; i < pattern.size(); ++i) {
        const char expected = pattern[step > 0 ? i : pattern.size() - 1 - i];
        switch (expected) {
        case '#':
            if (!is_vowel(letter(at))) {
                return false;
            }
            while (is_vowel(letter(at))) {
                at += step;
            }
            break;
        case ':':
            while (is_consonant(letter(at))) {
                at += step;
            }
            break;
        case '^':
            if (!is_consonant(letter(at))) {
                return false;
            }
            at += step;
            break;
        case '.':
            if (std::string_view("bdvgjlmnrwz").find(letter(at)) == std::string_view::npos) {
                return false;
            }
            at += step;
            break;
        case '&':
            if (std::string_view("scgzxj").find(letter(at)) == std::string_view::npos
                && !(
                    letter(at) == 'h'
                    && std::string_view("cs").find(letter(at + step)) != std::string_view::npos)) {
                return false;
            }
            at += step;
            break;
        case '+':
            if (std::string_view("eiy").find(letter(at)) == std::string_view::npos) {
                return false;
            }
            at += step;
            break;
        default:
            if (letter(at) != expected) {
                return false;
            }
            at += step;
        }
    }
    return true;
}

void append_sounds(std::string_view names, std::vector<Sound>& sounds) {
    while (!names.empty()) {
        const std::size_t end = std::min(names.find(' '), names.size());
        const int phoneme = find_phoneme(names.substr(0, end));
        LIMN_CHECK_NOTE(phoneme >= 0, "a phoneme of the spelling rules");
        sounds.push_back({.phoneme = static_cast<std::uint8_t>(phoneme)});
        names.remove_prefix(std::min(end + 1, names.size()));
    }
}

/// The sounds of a word of letters a to z. The first full vowel is stressed.
void append_word(std::string_view word, std::vector<Sound>& sounds) {
    const std::size_t first = sounds.size();
    const std::string_view known = sounds_of_word(word);
    append_sounds(known, sounds);
    for (std::size_t i = 0; known.empty() && i < word.size();) {
        const auto at = static_cast<std::ptrdiff_t>(i);
        const std::span<const SpellingRule> rules = spelling_rules(word[i]);
        const auto rule = std::ranges::find_if(rules, [&](const SpellingRule& candidate) {
            return word.substr(i).starts_with(candidate.letters)
                   && matches(candidate.left, word, at - 1, -1)
                   && matches(candidate.right, word, at + std::ssize(candidate.letters), 1);
        });
        LIMN_CHECK(rule != rules.end());
        append_sounds(rule->sounds, sounds);
        i += rule->letters.size();
    }
    if (sounds.size() > first) {
        sounds[first].starts_word = true;
    }
    const int schwa = find_phoneme("ax");
    for (std::size_t i = first; i < sounds.size(); ++i) {
        if (phonemes()[sounds[i].phoneme].is_vowel && sounds[i].phoneme != schwa) {
            sounds[i].stressed = true;
            break;
        }
    }
}

constexpr std::array<std::string_view, 20> kNumberWords{
    "zero",     "one",     "two",     "three",     "four",     "five",    "six",
    "seven",    "eight",   "nine",    "ten",       "eleven",   "twelve",  "thirteen",
    "fourteen", "fifteen", "sixteen", "seventeen", "eighteen", "nineteen"};
constexpr std::array<std::string_view, 10> kTens{"",      "",      "twenty",  "thirty", "forty",
                                                 "fifty", "sixty", "seventy", "eighty", "ninety"};

void append_number(std::uint32_t number, std::vector<Sound>& sounds) {
    if (number >= 1000) {
        append_number(number / 1000, sounds);
        append_word("thousand", sounds);
        number %= 1000;
        if (number == 0) {
            return;
        }
    }
    if (number >= 100) {
        append_word(kNumberWords[number / 100], sounds);
        append_word("hundred", sounds);
        number %= 100;
        if (number == 0) {
            return;
        }
    }
    if (number >= 20) {
        append_word(kTens[number / 10], sounds);
        number %= 10;
        if (number == 0) {
            return;
        }
    }
    append_word(kNumberWords[number], sounds);
}

/// The sounds of digits: as a number, or digit by digit if it is long or begins with 0.
void append_digits(std::string_view digits, std::vector<Sound>& sounds) {
    if (digits.size() <= 6 && (digits.size() == 1 || digits[0] != '0')) {
        append_number(static_cast<std::uint32_t>(std::stoul(std::string(digits))), sounds);
        return;
    }
    for (const char digit : digits) {
        append_number(static_cast<std::uint32_t>(digit - '0'), sounds);
    }
}

void append_pause(std::vector<Sound>& sounds) {
    if (!sounds.empty() && sounds.back().phoneme != 0) {
        sounds.back().ends_phrase = true;
        sounds.push_back({});
    }
}

void end_utterance(std::vector<Sound>& sounds) {
    append_pause(sounds);
    if (!sounds.empty()) {
        sounds.pop_back();
    }
}

}  // namespace

std::vector<Sound> sounds_of_text(std::string_view text) {
    std::string plain(text);
    std::ranges::transform(plain, plain.begin(), [](char c) {
        return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    });
    std::vector<Sound> sounds;
    for (std::size_t i = 0; i < plain.size();) {
        const auto run = [&](auto&& belongs) {
            std::size_t end = i;
            while (end < plain.size() && belongs(plain[end])) {
                ++end;
            }
            return std::string_view(plain).substr(i, end - i);
        };
        const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
        if (const std::string_view word = run(is_letter); !word.empty()) {
            append_word(word, sounds);
            i += word.size();
        } else if (const std::string_view digits = run(is_digit); !digits.empty()) {
            append_digits(digits, sounds);
            i += digits.size();
        } else {
            if (std::string_view(".,;:!?\n").find(plain[i]) != std::string_view::npos) {
                append_pause(sounds);
            }
            ++i;
        }
    }
    end_utterance(sounds);
    return sounds;
}

std::vector<Sound> sounds_of_ipa(std::string_view ipa) {
    std::vector<Sound> sounds;
    bool stressed = false;
    bool starts_word = true;
    while (!ipa.empty()) {
        if (ipa[0] == '\n' || ipa[0] == ' ') {
            if (ipa[0] == '\n') {
                append_pause(sounds);
            }
            starts_word = true;
            ipa.remove_prefix(1);
            continue;
        }
        if (ipa.starts_with(kStress) || ipa.starts_with(kSecondStress)) {
            stressed = ipa.starts_with(kStress);
            ipa.remove_prefix(kStress.size());
            continue;
        }
        // The longest symbol of any phoneme that matches here.
        std::size_t longest = 0;
        std::size_t found = 0;
        for (std::size_t p = 1; p < phonemes().size(); ++p) {
            for (std::string_view rest = phonemes()[p].ipa; rest.size() > 1;) {
                rest.remove_prefix(1);
                const std::string_view symbol = rest.substr(0, rest.find(' '));
                if (symbol.size() > longest && ipa.starts_with(symbol)) {
                    longest = symbol.size();
                    found = p;
                }
                rest.remove_prefix(symbol.size());
            }
        }
        if (longest > 0) {
            const bool is_vowel = phonemes()[found].is_vowel;
            sounds.push_back(
                {.phoneme = static_cast<std::uint8_t>(found),
                 .stressed = stressed && is_vowel,
                 .starts_word = starts_word});
            stressed = stressed && !is_vowel;
            starts_word = false;
        }
        ipa.remove_prefix(std::max<std::size_t>(longest, 1));
    }
    end_utterance(sounds);
    return sounds;
}

}  // namespace limn
