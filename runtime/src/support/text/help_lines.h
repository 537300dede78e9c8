#pragma once
#include <cstddef>
#include <string>

namespace galactic {

/// Formats --help so that an option and its explanation stand at least two blanks apart, or on
/// separate lines: a single blank separates them neither for readers nor for man page generators.
/// `Parser` is the formatter of a command-line parser, CLI::Formatter, and `Option` its
/// CLI::Option: this library does not depend on either.
template <class Parser, class Option>
class HelpLines : public Parser {
 public:
  std::string make_option(const Option* option, bool is_positional) const override {
    constexpr std::size_t kIndent = 2;
    std::string line = Parser::make_option(option, is_positional);
    const std::size_t width = kIndent + this->make_option_name(option, is_positional).size() +
                              this->make_option_opts(option).size();
    const std::size_t column = this->get_column_width();
    if (width + 1 == column) line.replace(width, 1, "\n" + std::string(column, ' '));
    return line;
  }
};

}  // namespace galactic
