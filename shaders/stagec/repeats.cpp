#include "repeats.hpp"
#include <algorithm>
#include <map>
#include <optional>

namespace stagec {
namespace {

using Words = std::set<std::string>;

// Names with the parts between their underscores replaced.
std::string renamed(const std::string& text, const std::map<std::string, std::string>& parts) {
    std::string out;
    for (std::size_t at = 0; at < text.size();) {
        const std::string word = word_at(text, at);
        if (word.empty()) {
            out += text[at++];
            continue;
        }
        at += word.size();
        for (std::size_t from = 0; from <= word.size();) {
            const std::size_t end = std::min(word.find('_', from), word.size());
            const std::string part = word.substr(from, end - from);
            const auto found = parts.find(part);
            out += (found == parts.end() ? part : found->second) + (end < word.size() ? "_" : "");
            from = end + 1;
        }
    }
    return out;
}

std::string flat(std::string text) {
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text;
}

std::string tidy(const std::string& text) {
    std::string out;
    for (const char c : flat(text))
        if (c != ' ' || (!out.empty() && out.back() != ' ')) out += c;
    while (!out.empty() && out.back() == ' ') out.pop_back();
    return out;
}

// One piece of a block: a statement up to its semicolon, or text that stands once (braces, else, conditions).
struct Piece {
    std::string text;
    std::size_t at = 0;
    bool statement = false;
};

bool has_axis_part(const std::string& word) { return other_axis(word) != word; }

class Block {
  public:
    Block(const Source& source, std::size_t begin, std::size_t end, const std::map<std::string, std::set<std::size_t>>& refs)
        : source_(source), refs_(refs) {
        split(begin, end);
    }

    /// Adds the locals that are another for each axis; true if there were new ones.
    bool find_locals(const Words& declared, Words& locals) const {
        const std::size_t before = locals.size();
        for (const auto& piece : pieces_) {
            if (!piece.statement || !differs(piece.text, locals)) continue;
            for (const auto& name : changed_by(piece, declared)) {
                if (!declared.count(name)) continue;
                if (has_axis_part(name))
                    source_.fail(piece.at, name + " has an axis in its name; in EACH_AXIS locals get one by themselves");
                locals.insert(name);
            }
        }
        return locals.size() != before;
    }

    const Words& declared() const { return declared_; }

    std::string text(const Words& locals) const {
        std::string out;
        bool any = false;
        for (const auto& piece : pieces_) {
            if (!differs(piece.text, locals)) {
                out += piece.text;
            } else if (!piece.statement) {
                source_.fail(piece.at, "the condition is another for each axis: select inside the block");
            } else {
                any = true;
                const std::size_t begin = skip_blanks(piece.text, 0);
                const std::string statement = piece.text.substr(begin);
                out += piece.text.substr(0, begin) + flat(for_axis(statement, locals, "_x")) + " " +
                       other_axis_of(statement, locals);
            }
        }
        if (!any) source_.fail(pieces_.empty() ? 0 : pieces_.front().at, "nothing in EACH_AXIS is another for each axis");
        return out;
    }

  private:
    void split(std::size_t begin, std::size_t end) {
        const std::string& text = source_.text;
        for (std::size_t at = begin; at < end;) {
            const std::size_t first = skip_blanks(text, at);
            if (first >= end) {
                pieces_.push_back({text.substr(at, end - at), first});
                break;
            }
            const std::string word = word_at(text, first);
            std::size_t stop = 0;
            bool statement = false;
            if (text[first] == '{' || text[first] == '}') {
                stop = first + 1;
            } else if (text[first] == '#') {
                source_.fail(first, "no preprocessor lines in EACH_AXIS");
            } else if (word == "else") {
                stop = first + word.size();
                const std::size_t next = skip_blanks(text, stop);
                if (text[next] != '{' && word_at(text, next) != "if") source_.fail(first, "braces behind else in EACH_AXIS");
            } else if (word == "return") {
                source_.fail(first, "no return in EACH_AXIS");
            } else if (word == "if" || word == "for") {
                stop = behind_bracket(source_, skip_blanks(text, first + word.size()));
                if (text[skip_blanks(text, stop)] != '{') { // its one statement goes with the condition
                    stop = statement_end(skip_blanks(text, stop));
                    statement = true;
                }
            } else {
                stop = statement_end(first);
                statement = true;
                note_declared(first, stop);
            }
            pieces_.push_back({text.substr(at, stop - at), first, statement});
            at = stop;
        }
    }

    std::size_t statement_end(std::size_t at) const {
        const std::string& text = source_.text;
        while (at < text.size() && text[at] != ';') {
            if (text[at] == '{' || text[at] == '}') source_.fail(at, "a brace where a statement's ; was expected");
            at = text[at] == '(' || text[at] == '[' ? behind_bracket(source_, at) : at + 1;
        }
        return at + 1;
    }

    // "type name = ...;" or "type name;"
    void note_declared(std::size_t begin, std::size_t end) {
        const std::string& text = source_.text;
        std::string type = word_at(text, begin);
        std::size_t at = skip_blanks(text, begin + type.size());
        if (type == "const") at = skip_blanks(text, at + word_at(text, at).size());
        const std::string name = word_at(text, at);
        if (type.empty() || name.empty() || at >= end) return;
        const char next = text[skip_blanks(text, at + name.size())];
        if (next == ',') source_.fail(at, "one declaration a statement in EACH_AXIS");
        if (next == '=' || next == ';') declared_.insert(name);
    }

    static bool names(const std::string& text, const Words& locals) {
        bool found = false;
        for_each_word(text, [&](const std::string& word, std::size_t at) {
            found |= locals.count(word) != 0 && (at == 0 || text[at - 1] != '.');
        });
        return found;
    }

    static bool differs(const std::string& text, const Words& locals) {
        return tidy(other_axis(text)) != tidy(text) || names(text, locals);
    }

    // What a statement assigns or hands to a function that changes it.
    Words changed_by(const Piece& piece, const Words& declared) const {
        Words changed;
        const std::string& text = piece.text;
        for_each_word(text, [&](const std::string& word, std::size_t at) {
            const std::size_t behind = at + word.size();
            std::size_t next = skip_blanks(text, behind);
            while (next < text.size() && text[next] == '.') { // a member
                next = skip_blanks(text, next + 1);
                next = skip_blanks(text, next + word_at(text, next).size());
            }
            const std::string two = next < text.size() ? text.substr(next, 2) : "";
            if (two.empty()) return;
            const bool assigned = (two[0] == '=' && two != "==") ||
                                  (two.size() == 2 && two[1] == '=' && std::string("+-*/").find(two[0]) != std::string::npos);
            if (assigned && (at == 0 || text[at - 1] != '.')) changed.insert(word);
            if (two[0] == ';' && declared.count(word)) changed.insert(word);
            const auto function = refs_.find(word);
            if (function == refs_.end() || two[0] != '(') return;
            const auto given = arguments({source_.path, text}, behind);
            for (const std::size_t n : function->second)
                if (n < given.size()) changed.insert(word_at(given[n], 0));
        });
        return changed;
    }

    // The locals get the axis as suffix.
    static std::string for_axis(const std::string& text, const Words& locals, const std::string& suffix) {
        std::string out;
        for (std::size_t at = 0; at < text.size();) {
            const std::string word = word_at(text, at);
            const bool member = at > 0 && text[at - 1] == '.';
            out += word.empty() ? std::string(1, text[at]) : word + (!member && locals.count(word) ? suffix : "");
            at += word.empty() ? 1 : word.size();
        }
        return out;
    }

    static std::string other_axis_of(const std::string& text, const Words& locals) {
        return for_axis(other_axis(text), locals, "_y");
    }

    const Source& source_;
    const std::map<std::string, std::set<std::size_t>>& refs_;
    std::vector<Piece> pieces_;
    Words declared_;
};

// Functions with REF parameters: their names and which parameters those are.
std::map<std::string, std::set<std::size_t>> functions_that_change(const std::string& text) {
    std::map<std::string, std::set<std::size_t>> found;
    const Source source{"", text};
    for_each_word(text, [&](const std::string& word, std::size_t at) {
        if (word != "FN" && word != "HELPER") return;
        at = skip_blanks(text, at + word.size());
        at = skip_blanks(text, at + word_at(text, at).size()); // behind the type
        const std::string name = word_at(text, at);
        const auto parameters = arguments(source, at + name.size());
        for (std::size_t n = 0; n < parameters.size(); ++n)
            if (parameters[n].starts_with("REF(")) found[name].insert(n);
    });
    return found;
}

// A stage or part of one in which every EACH_OF function is written for each of its words.
Source words_written_out(const Source& stage) {
    Source out{stage.path, {}};
    for (std::size_t at = 0; at < stage.text.size();) {
        const std::string word = word_at(stage.text, at);
        if (word != "EACH_OF") {
            const std::size_t step = word.empty() ? 1 : word.size();
            out.text += stage.text.substr(at, step);
            at += step;
            continue;
        }
        const auto words = arguments(stage, at + word.size());
        if (words.size() != 2) stage.fail(at, "EACH_OF takes (name, other name)");
        const std::size_t begin = behind_bracket(stage, skip_blanks(stage.text, at + word.size()));
        const std::string next = word_at(stage.text, skip_blanks(stage.text, begin));
        if (next != "HELPER" && next != "EACH_AXIS") stage.fail(at, "EACH_OF stands before a HELPER");
        const std::size_t body = stage.text.find('{', begin);
        if (body == std::string::npos) stage.fail(at, "EACH_OF stands before a HELPER");
        const std::size_t end = behind_bracket(stage, body);
        const std::string text = stage.text.substr(begin, end - begin);
        const std::string other = renamed(text, {{words[0], words[1]}});
        if (other == text) stage.fail(at, "nothing in this function is named for " + words[0]);
        out.text += flat(text) + other;
        at = end;
    }
    return out;
}

} // namespace

std::string other_axis(const std::string& text) {
    static const std::map<std::string, std::string> parts = {{"x", "y"},          {"y", "x"},         {"xx", "yy"}, {"yy", "xx"},
                                                             {"i", "j"},          {"j", "i"},         {"nx", "ny"}, {"ny", "nx"},
                                                             {"columns", "rows"}, {"rows", "columns"}};
    const Source swapped{"", renamed(text, parts)};
    std::string out;
    for (std::size_t at = 0; at < swapped.text.size();) {
        const std::string word = word_at(swapped.text, at);
        if (word != "IDX") {
            const std::size_t step = word.empty() ? 1 : word.size();
            out += swapped.text.substr(at, step);
            at += step;
            continue;
        }
        const std::size_t open = skip_blanks(swapped.text, at + word.size()), end = behind_bracket(swapped, open) - 1;
        int depth = 0;
        std::size_t comma = open + 1;
        while (comma < end && (depth != 0 || swapped.text[comma] != ',')) {
            depth += swapped.text[comma] == '(' ? 1 : swapped.text[comma] == ')' ? -1 : 0;
            ++comma;
        }
        const std::size_t second = std::min(skip_blanks(swapped.text, comma + 1), end);
        out += "IDX(" + swapped.text.substr(second, end - second) + ", " + swapped.text.substr(open + 1, comma - open - 1) + ")";
        at = end + 1;
    }
    return out;
}

Source written_out(const Source& given, const std::string& reads) {
    const Source stage = words_written_out(given);
    const auto refs = functions_that_change(reads + stage.text);
    struct Found {
        std::size_t begin, end; // of the whole construct
        std::optional<Block> block;
        std::string text;
    };
    std::vector<Found> all;
    for_each_word(stage.text, [&](const std::string& word, std::size_t at) {
        if (word != "EACH_AXIS") return;
        const std::size_t next = skip_blanks(stage.text, at + word.size());
        if (next < stage.text.size() && stage.text[next] == '{') {
            const std::size_t end = behind_bracket(stage, next);
            all.push_back({at, end, Block(stage, next + 1, end - 1, refs), {}});
        } else if (word_at(stage.text, next) == "HELPER") {
            const std::size_t end = behind_bracket(stage, std::min(stage.text.find('{', next), stage.text.size() - 1));
            const std::string text = stage.text.substr(next, end - next);
            const std::string other = other_axis(text);
            if (tidy(other) == tidy(text)) stage.fail(at, "nothing in this function is another for each axis");
            all.push_back({at, end, {}, stage.text.substr(at + word.size(), next - at - word.size()) + flat(text) + " " + other});
        } else {
            stage.fail(at, "EACH_AXIS stands before a block or a HELPER");
        }
    });
    Words locals, declared;
    for (const auto& found : all)
        if (found.block) declared.insert(found.block->declared().begin(), found.block->declared().end());
    for_each_word(stage.text, [&](const std::string& word, std::size_t) { // named for an axis outside the block
        for (const auto& name : declared)
            if (word == name + "_x" || word == name + "_y") locals.insert(name);
    });
    for (bool more = true; more;) {
        more = false;
        for (const auto& found : all)
            if (found.block) more |= found.block->find_locals(declared, locals);
    }
    for_each_word(stage.text, [&](const std::string& word, std::size_t at) {
        for (const char* suffix : {"_x", "_y"})
            for (const char* binding : {"IN", "OUT", "INOUT", "IN_IF", "OUT_IF", "INOUT_IF"})
                if (word == binding)
                    for (const auto& local : locals)
                        if (arguments(stage, at + word.size()).back() == local + suffix)
                            stage.fail(at, local + " of EACH_AXIS would be named as this binding");
    });
    Source out{stage.path, {}};
    std::size_t at = 0;
    for (const auto& found : all) {
        out.text += stage.text.substr(at, found.begin - at) + (found.block ? found.block->text(locals) : found.text);
        at = found.end;
    }
    out.text += stage.text.substr(at);
    return out;
}

} // namespace stagec
