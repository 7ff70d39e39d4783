#pragma once
// A few hundred lines of a job around one of them, read in a thread: a job of a million lines opens at once.

#include <QEvent>
#include <QPlainTextEdit>
#include <QResizeEvent>
#include <QSyntaxHighlighter>
#include <QTextDocument>
#include <QVector>
#include <QWidget>

#include "gui/views/theme.hpp"

namespace kinebus::gui {

class GcodeHighlighter : public QSyntaxHighlighter {
  Q_OBJECT
 public:
  GcodeHighlighter(QTextDocument* document, const Theme& theme);

 protected:
  void highlightBlock(const QString& text) override;

 private:
  const Theme& theme_;
};

/// A text with line numbers beside it.
class NumberedText : public QPlainTextEdit {
  Q_OBJECT
 public:
  explicit NumberedText(const Theme& theme, QWidget* parent = nullptr);
  void set_first_line(int number);
  void mark_lines(const QVector<int>& numbers);
  void go_to(int number, int column = 0);
  int first_line() const { return first_line_; }

 protected:
  void resizeEvent(QResizeEvent* event) override;
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  int gutter_width() const;
  void place_gutter();
  void paint_gutter();
  void take_theme();
  void show_marks();

  const Theme& theme_;
  QWidget* gutter_;
  int first_line_ = 1;
  int current_ = 0;
  QVector<int> marks_;
};

class LineView : public NumberedText {
  Q_OBJECT
 public:
  explicit LineView(const Theme& theme, QWidget* parent = nullptr);
  void show_line(const QString& file_path, int line, int column = 0);
  void show_nothing();

 private:
  int wanted_ = 0;
};

}  // namespace kinebus::gui
