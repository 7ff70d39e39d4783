#include "tools/schematic/s_expression.hpp"

#include <fmt/format.h>

#include <cstdlib>

namespace kinebus::schematic {
namespace {

constexpr int kDeepest = 100;

class Reader {
 public:
  Reader(std::string_view text, const std::string& file) : text_(text), file_(file) {}

  Result<Expression, FileError> read(int depth) {
    skip_space();
    if (at_ == text_.size()) return wrong("the file ends within a list");
    if (text_[at_] != '(') return read_word();
    if (depth == kDeepest) return wrong(fmt::format("more than {} lists in one another", kDeepest));
    Expression list;
    list.line = line_;
    ++at_;
    for (;;) {
      skip_space();
      if (at_ == text_.size()) return wrong(fmt::format("the list of line {} is not closed", list.line));
      if (text_[at_] == ')') break;
      auto item = read(depth + 1);
      if (!item) return item;
      list.items.push_back(std::move(*item));
    }
    ++at_;
    return list;
  }
  Result<Expression, FileError> read_all() {
    auto list = read(0);
    if (!list) return list;
    skip_space();
    if (at_ != text_.size()) return wrong("one list was expected, and more follows");
    if (!list->word.empty()) return wrong("a list was expected");
    return list;
  }

 private:
  Result<Expression, FileError> wrong(std::string words) const {
    return Error<FileError>(FileError{file_, line_, std::move(words)});
  }
  void skip_space() {
    for (; at_ < text_.size() &&
           (text_[at_] == ' ' || text_[at_] == '\n' || text_[at_] == '\t' || text_[at_] == '\r');
         ++at_)
      if (text_[at_] == '\n') ++line_;
  }
  Result<Expression, FileError> read_word() {
    Expression word;
    word.line = line_;
    if (text_[at_] == ')') return wrong("a bracket is closed that was not opened");
    if (text_[at_] != '"') {
      while (at_ < text_.size() && std::string_view(" \n\t\r()").find(text_[at_]) == std::string_view::npos)
        word.word += text_[at_++];
      return word;
    }
    for (++at_; at_ < text_.size() && text_[at_] != '"'; ++at_) {
      if (text_[at_] == '\n') ++line_;
      if (text_[at_] == '\\' && at_ + 1 < text_.size()) ++at_;
      word.word += text_[at_];
    }
    if (at_ == text_.size())
      return wrong(fmt::format("the text that begins in line {} has no end", word.line));
    ++at_;
    return word;
  }

  std::string_view text_;
  const std::string& file_;
  std::size_t at_ = 0, line_ = 1;
};

}  // namespace

std::string FileError::text() const {
  return line == 0 ? fmt::format("{}: {}", file, words) : fmt::format("{}:{}: {}", file, line, words);
}

const Expression* Expression::find(std::string_view name) const {
  for (const Expression& item : items)
    if (item.is(name)) return &item;
  return nullptr;
}

std::string_view Expression::at(std::size_t index) const {
  return index < items.size() ? std::string_view(items[index].word) : std::string_view();
}

double Expression::number(std::size_t index) const {
  return index < items.size() ? std::strtod(items[index].word.c_str(), nullptr) : 0;
}

Result<Expression, FileError> parse_expression(std::string_view text, const std::string& file) {
  return Reader(text, file).read_all();
}

}  // namespace kinebus::schematic
