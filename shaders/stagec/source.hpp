// Text that stagec reads: words, arguments, and messages that name file and line.
#pragma once
#include <set>
#include <string>
#include <vector>

namespace stagec {

[[noreturn]] void fail(const std::string& message);
std::string read_text(const std::string& path);
void write_bytes(const std::string& path, const std::string& bytes);
/// Writes a generated source; lines that say only `here` become #line with the number and name of the line that follows.
void write_code(const std::string& path, const std::string& text);
inline constexpr const char* here = "#line HERE\n";
/// File name without folder and extension.
std::string stem(const std::string& path);

/// A file without its comments, line for line, or what is written from it, with #line where that is another line.
struct Source {
    std::string path, text;
    int line(std::size_t at) const;
    /// #line for text that is written anew from the line of `at` on.
    std::string goes_on_at(std::size_t at) const;
    /// "path:line", as compilers write it.
    std::string place(std::size_t at) const;
    [[noreturn]] void fail(std::size_t at, const std::string& message) const { stagec::fail(place(at) + ": " + message); }
};

/// Comments are // only: a block comment is refused.
Source read_source(const std::string& path);

bool is_word(char c);
/// The word (letters, digits, underscores) that begins at `at`.
std::string word_at(const std::string& text, std::size_t at);
/// The next character from `at` on that is no blank; the text's length at its end.
std::size_t skip_blanks(const std::string& text, std::size_t at);
/// Behind the bracket that closes the one at `at`: ( [ or {.
std::size_t behind_bracket(const Source& source, std::size_t at);
/// The arguments of a macro call whose name ends at `at`, without blanks; empty when no parenthesis follows.
std::vector<std::string> arguments(const Source& source, std::size_t at);
/// Names that begin with EFFECT_ in an expression.
std::set<std::string> effects_in(const std::string& expression);
/// Calls `use(word, at)` for each word of the text that is no number; `at` is where it begins.
template <class Use> void for_each_word(const std::string& text, const Use& use) {
    for (std::size_t at = 0; at < text.size();) {
        const std::string word = word_at(text, at);
        if (!word.empty() && (word[0] < '0' || word[0] > '9')) use(word, at);
        at += word.empty() ? 1 : word.size();
    }
}

} // namespace stagec
