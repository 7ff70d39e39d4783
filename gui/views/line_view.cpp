#include "gui/views/line_view.hpp"

#include <QByteArray>
#include <QChar>
#include <QColor>
#include <QCoreApplication>
#include <QEvent>
#include <QFile>
#include <QFont>
#include <QIODevice>
#include <QLatin1Char>
#include <QList>
#include <QMetaObject>
#include <QPainter>
#include <QPointer>
#include <QRect>
#include <QRectF>
#include <QResizeEvent>
#include <QStringList>
#include <QTextBlock>
#include <QTextCharFormat>
#include <QTextCursor>
#include <QTextDocument>
#include <QTextEdit>
#include <QTextFormat>
#include <QTextOption>
#include <QThreadPool>
#include <QVector>
#include <QWidget>

namespace kinebus::gui {
namespace {

constexpr int kAround = 150;  ///< lines before and after

struct Excerpt {
  QString text;
  int first = 1;
};

Excerpt read_excerpt(const QString& path, int line) {
  QFile file(path);
  if (!file.open(QIODevice::ReadOnly)) return {};
  Excerpt excerpt;
  excerpt.first = std::max(1, line - kAround);
  int number = 1;
  QByteArray rest;
  QStringList lines;
  constexpr qint64 kPart = 1 << 20;
  while (!file.atEnd() && number <= line + kAround) {
    const QByteArray part = rest + file.read(kPart);
    qsizetype from = 0;
    for (qsizetype end = part.indexOf('\n', from); end >= 0 && number <= line + kAround;
         end = part.indexOf('\n', from)) {
      if (number >= excerpt.first)
        lines << QString::fromUtf8(part.mid(from, end - from)).remove(QLatin1Char('\r'));
      ++number;
      from = end + 1;
    }
    rest = part.mid(from);
  }
  if (number >= excerpt.first && number <= line + kAround && !rest.isEmpty())
    lines << QString::fromUtf8(rest);
  excerpt.text = lines.join(QLatin1Char('\n'));
  return excerpt;
}

}  // namespace

GcodeHighlighter::GcodeHighlighter(QTextDocument* document, const Theme& theme)
    : QSyntaxHighlighter(document), theme_(theme) {
  connect(&theme, &Theme::changed, this, &QSyntaxHighlighter::rehighlight);
}

void GcodeHighlighter::highlightBlock(const QString& text) {
  const ThemeColours& colours = theme_.colours();
  for (int i = 0; i < text.size(); ++i) {
    const QChar c = text[i].toUpper();
    if (c == QLatin1Char(';')) {
      setFormat(i, static_cast<int>(text.size()) - i, colours.muted);
      return;
    }
    if (c == QLatin1Char('(')) {
      const auto end = text.indexOf(QLatin1Char(')'), i);
      const int length = end < 0 ? static_cast<int>(text.size()) - i : static_cast<int>(end) - i + 1;
      setFormat(i, length, colours.muted);
      i += length - 1;
      continue;
    }
    if (!c.isLetter()) continue;
    int end = i + 1;
    while (end < text.size() && !text[end].isLetter() && !text[end].isSpace() &&
           text[end] != QLatin1Char(';'))
      ++end;
    if (c == QLatin1Char('G') || c == QLatin1Char('M') || c == QLatin1Char('T')) {
      QTextCharFormat format;
      format.setForeground(colours.accent);
      format.setFontWeight(QFont::DemiBold);
      setFormat(i, end - i, format);
    } else if (c == QLatin1Char('F') || c == QLatin1Char('S')) {
      setFormat(i, end - i, colours.waiting);
    } else {
      setFormat(i, 1, colours.muted);
    }
    i = end - 1;
  }
}

NumberedText::NumberedText(const Theme& theme, QWidget* parent)
    : QPlainTextEdit(parent), theme_(theme), gutter_(new QWidget(this)) {
  setProperty("mono", true);
  setLineWrapMode(QPlainTextEdit::NoWrap);
  setLayoutDirection(Qt::LeftToRight);
  QTextOption option = document()->defaultTextOption();
  option.setTextDirection(Qt::LeftToRight);
  document()->setDefaultTextOption(option);
  setTabChangesFocus(true);  // the keyboard can always leave
  gutter_->installEventFilter(this);
  connect(this, &QPlainTextEdit::blockCountChanged, this, &NumberedText::place_gutter);
  connect(this, &QPlainTextEdit::updateRequest, this, [this](const QRect& rect, int dy) {
    if (dy != 0)
      gutter_->scroll(0, dy);
    else
      gutter_->update(0, rect.y(), gutter_->width(), rect.height());
  });
  connect(&theme, &Theme::changed, this, &NumberedText::show_marks);
  place_gutter();
}

void NumberedText::set_first_line(int number) {
  first_line_ = number;
  place_gutter();
}

int NumberedText::gutter_width() const {
  const auto digits = QString::number(first_line_ + blockCount()).size();
  return fontMetrics().horizontalAdvance(QLatin1Char('0')) * static_cast<int>(digits) + 18;
}

void NumberedText::place_gutter() {
  setViewportMargins(gutter_width(), 0, 0, 0);
  const QRect room = contentsRect();
  gutter_->setGeometry(room.left(), room.top(), gutter_width(), room.height());
}

void NumberedText::resizeEvent(QResizeEvent* event) {
  QPlainTextEdit::resizeEvent(event);
  place_gutter();
}

bool NumberedText::eventFilter(QObject* watched, QEvent* event) {
  if (watched == gutter_ && event->type() == QEvent::Paint) {
    paint_gutter();
    return true;
  }
  return QPlainTextEdit::eventFilter(watched, event);
}

void NumberedText::paint_gutter() {
  QPainter painter(gutter_);
  painter.setFont(font());
  QTextBlock block = firstVisibleBlock();
  double top = blockBoundingGeometry(block).translated(contentOffset()).top();
  while (block.isValid() && top <= gutter_->height()) {
    const double height = blockBoundingRect(block).height();
    const int number = first_line_ + block.blockNumber();
    const bool wrong = marks_.contains(number);
    painter.setPen(wrong                ? theme_.colours().danger
                   : number == current_ ? theme_.colours().accent
                                        : theme_.colours().muted);
    painter.drawText(QRectF(0, top, gutter_->width() - 9, height),
                     Qt::AlignRight | Qt::AlignVCenter | Qt::TextForceLeftToRight, QString::number(number));
    top += height;
    block = block.next();
  }
}

void NumberedText::mark_lines(const QVector<int>& numbers) {
  marks_ = numbers;
  show_marks();
}

void NumberedText::show_marks() {
  QList<QTextEdit::ExtraSelection> selections;
  const auto add = [&](int number, QColor colour, int alpha) {
    const QTextBlock block = document()->findBlockByNumber(number - first_line_);
    if (!block.isValid()) return;
    colour.setAlpha(alpha);
    QTextEdit::ExtraSelection selection;
    selection.cursor = QTextCursor(block);
    selection.format.setBackground(colour);
    selection.format.setProperty(QTextFormat::FullWidthSelection, true);
    selections.push_back(selection);
  };
  for (const int number : marks_) add(number, theme_.colours().danger, 45);
  if (current_ > 0) add(current_, theme_.colours().accent, 55);
  setExtraSelections(selections);
  gutter_->update();
}

void NumberedText::go_to(int number, int column) {
  const QTextBlock block = document()->findBlockByNumber(number - first_line_);
  if (!block.isValid()) return;
  current_ = number;
  QTextCursor cursor(block);
  if (column > 1)
    cursor.movePosition(QTextCursor::Right, QTextCursor::MoveAnchor,
                        std::min(column - 1, block.length() - 1));
  setTextCursor(cursor);
  centerCursor();
  show_marks();
}

LineView::LineView(const Theme& theme, QWidget* parent) : NumberedText(theme, parent) {
  setReadOnly(true);
  new GcodeHighlighter(document(), theme);
}

void LineView::show_nothing() {
  wanted_ = 0;
  clear();
}

void LineView::show_line(const QString& file_path, int line, int column) {
  wanted_ = line;
  QThreadPool::globalInstance()->start([self = QPointer<LineView>(this), file_path, line, column] {
    const Excerpt excerpt = read_excerpt(file_path, line);
    QMetaObject::invokeMethod(
        qApp,
        [self, excerpt, line, column] {
          if (self.isNull() || self->wanted_ != line) return;
          self->setPlainText(excerpt.text);
          self->set_first_line(excerpt.first);
          self->go_to(line, column);
        },
        Qt::QueuedConnection);
  });
}

}  // namespace kinebus::gui
