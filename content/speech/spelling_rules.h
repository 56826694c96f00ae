#pragma once

#include <span>
#include <string_view>

namespace limn {

/// `letters` of a word between `left` and `right` are read as `sounds`. Patterns: a letter is
/// itself, ' ' the edge of the word, # one or more vowels, : any number of consonants, ^ one
/// consonant,
/// + one of e i y, % one of the endings e ed er es est ing ely, . a voiced consonant, & a sibilant.
struct SpellingRule {
    std::string_view left;
    std::string_view letters;
    std::string_view right;
    std::string_view sounds;  ///< names of phonemes, separated by spaces; ' after a vowel: stressed
};

/// Rules for a letter; the first match is used. A rule without patterns ends the list of each
/// letter, so that one always matches.
[[nodiscard]] std::span<const SpellingRule> spelling_rules(char letter);

/// The sounds of a frequent word that no rule gets right, or "".
[[nodiscard]] std::string_view sounds_of_word(std::string_view word);

}  // namespace limn
