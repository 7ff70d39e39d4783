#include "gui/views/console_page.hpp"

#include <QAbstractItemView>
#include <QCoreApplication>
#include <QEvent>
#include <QFont>
#include <QHBoxLayout>
#include <QKeyEvent>
#include <QLatin1Char>
#include <QModelIndex>
#include <QPointer>
#include <QPushButton>
#include <QStandardItem>
#include <QStandardItemModel>
#include <QTextBlock>
#include <QTextCharFormat>
#include <QTextCursor>
#include <QVBoxLayout>
#include <QWidget>

#include "gui/session/gateway_words.hpp"

namespace kinebus::gui {
namespace {

constexpr int kHistory = 200;
constexpr int kLines = 3000;

struct Hint {
  const char* code;
  const char* words;
};
// What the gateway's console understands, with what it does.
constexpr std::array<Hint, 30> kHints{{
    {"G0", QT_TRANSLATE_NOOP("ConsoleHints", "traverse")},
    {"G1", QT_TRANSLATE_NOOP("ConsoleHints", "straight line at feed")},
    {"G2", QT_TRANSLATE_NOOP("ConsoleHints", "arc, clockwise")},
    {"G3", QT_TRANSLATE_NOOP("ConsoleHints", "arc, counter-clockwise")},
    {"G28", QT_TRANSLATE_NOOP("ConsoleHints", "home, or go to the bed reference")},
    {"G54", QT_TRANSLATE_NOOP("ConsoleHints", "first work coordinate system")},
    {"G55", QT_TRANSLATE_NOOP("ConsoleHints", "second work coordinate system")},
    {"G90", QT_TRANSLATE_NOOP("ConsoleHints", "absolute positions")},
    {"G91", QT_TRANSLATE_NOOP("ConsoleHints", "relative positions")},
    {"G92", QT_TRANSLATE_NOOP("ConsoleHints", "call this position so")},
    {"M17", QT_TRANSLATE_NOOP("ConsoleHints", "motors on")},
    {"M18", QT_TRANSLATE_NOOP("ConsoleHints", "motors off")},
    {"M20", QT_TRANSLATE_NOOP("ConsoleHints", "list the jobs")},
    {"M23", QT_TRANSLATE_NOOP("ConsoleHints", "choose a job")},
    {"M24", QT_TRANSLATE_NOOP("ConsoleHints", "start or resume")},
    {"M25", QT_TRANSLATE_NOOP("ConsoleHints", "pause")},
    {"M27", QT_TRANSLATE_NOOP("ConsoleHints", "progress of the job")},
    {"M31", QT_TRANSLATE_NOOP("ConsoleHints", "time of the job")},
    {"M82", QT_TRANSLATE_NOOP("ConsoleHints", "extruder absolute")},
    {"M83", QT_TRANSLATE_NOOP("ConsoleHints", "extruder relative")},
    {"M104", QT_TRANSLATE_NOOP("ConsoleHints", "heat the nozzle")},
    {"M105", QT_TRANSLATE_NOOP("ConsoleHints", "temperatures")},
    {"M106", QT_TRANSLATE_NOOP("ConsoleHints", "fan on")},
    {"M107", QT_TRANSLATE_NOOP("ConsoleHints", "fan off")},
    {"M109", QT_TRANSLATE_NOOP("ConsoleHints", "heat the nozzle and wait")},
    {"M112", QT_TRANSLATE_NOOP("ConsoleHints", "emergency stop")},
    {"M114", QT_TRANSLATE_NOOP("ConsoleHints", "position")},
    {"M115", QT_TRANSLATE_NOOP("ConsoleHints", "name and capabilities")},
    {"M119", QT_TRANSLATE_NOOP("ConsoleHints", "switches")},
    {"M140", QT_TRANSLATE_NOOP("ConsoleHints", "heat the bed")},
}};

}  // namespace

ConsolePage::ConsolePage(Desk& desk, QWidget* parent) : SpeakingWidget(parent), desk_(desk) {
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(14, 12, 14, 12);
  column->setSpacing(10);
  text_ = new QPlainTextEdit(this);
  text_->setReadOnly(true);
  text_->setProperty("mono", true);
  text_->setMaximumBlockCount(kLines);
  text_->setLayoutDirection(Qt::LeftToRight);
  text_->setTabChangesFocus(true);
  line_ = new QLineEdit(this);
  line_->setProperty("mono", true);
  line_->setLayoutDirection(Qt::LeftToRight);
  line_->installEventFilter(this);
  send_ = make_button(desk_.theme, QStringLiteral("console"), "primary", this);
  completer_ = new QCompleter(line_);
  completer_->setModel(new QStandardItemModel(static_cast<int>(kHints.size()), 1, completer_));
  completer_->setCaseSensitivity(Qt::CaseInsensitive);
  completer_->setCompletionMode(QCompleter::PopupCompletion);
  completer_->setCompletionRole(Qt::UserRole);
  completer_->setWidget(line_);
  connect(completer_, QOverload<const QModelIndex&>::of(&QCompleter::activated), this,
          [this](const QModelIndex& index) {
            line_->setText(index.data(Qt::UserRole).toString() + QLatin1Char(' '));
          });
  auto* row = new QHBoxLayout;
  row->setSpacing(8);
  row->addWidget(line_, 1);
  row->addWidget(send_);
  column->addWidget(text_, 1);
  column->addLayout(row);
  const auto send_line = [this] {
    const QString line = line_->text().trimmed();
    if (line.isEmpty()) return;
    line_->clear();
    send(line);
  };
  connect(line_, &QLineEdit::returnPressed, this, send_line);
  connect(send_, &QPushButton::clicked, this, send_line);
  connect(line_, &QLineEdit::textEdited, this, &ConsolePage::complete);
  connect(&desk_.session, &Session::event_arrived, this, [this](const joblink::Event& event) {
    if (event.kind() == joblink::EVENT_MESSAGE)
      append(GatewayWords::said(event.said(), event.words()), Voice::kMessage);
    if (event.kind() == joblink::EVENT_ALARM)
      append(GatewayWords::said(event.said(), event.words()), Voice::kRefusal);
  });
  connect(&desk_.theme, &Theme::changed, this, &ConsolePage::recolour);
  setFocusProxy(line_);
  says([this] {
    send_->setText(tr("Send"));
    text_->setAccessibleName(tr("Answers of the gateway"));
    text_->setPlaceholderText(tr("Lines you send and the gateway's answers appear here."));
    line_->setPlaceholderText(tr("G-code or M-code, for example M114"));
    line_->setAccessibleName(line_->placeholderText());
    auto* model = qobject_cast<QStandardItemModel*>(completer_->model());
    for (std::size_t i = 0; i < kHints.size(); ++i) {
      const QString code = QString::fromLatin1(kHints[i].code);
      auto* item = new QStandardItem(
          QStringLiteral("%1   %2").arg(code, QCoreApplication::translate("ConsoleHints", kHints[i].words)));
      item->setData(code, Qt::UserRole);
      model->setItem(static_cast<int>(i), item);
    }
  });
}

QTextCharFormat ConsolePage::format_of(Voice voice) const {
  const ThemeColours& colours = desk_.theme.colours();
  QTextCharFormat format;
  switch (voice) {
    case Voice::kUser:
      format.setForeground(colours.text);
      format.setFontWeight(QFont::DemiBold);
      break;
    case Voice::kAnswer:
      format.setForeground(colours.muted);
      break;
    case Voice::kRefusal:
      format.setForeground(colours.danger);
      break;
    case Voice::kMessage:
      format.setForeground(colours.busy);
      break;
  }
  return format;
}

void ConsolePage::append(const QString& text, Voice voice) {
  QTextCursor cursor(text_->document());
  cursor.movePosition(QTextCursor::End);
  for (const QString& line : text.split(QLatin1Char('\n'))) {
    if (!text_->document()->isEmpty()) cursor.insertBlock();
    cursor.block().setUserState(static_cast<int>(voice));
    cursor.insertText(line, format_of(voice));
  }
  text_->moveCursor(QTextCursor::End);
  text_->ensureCursorVisible();
}

/// Lines keep their meaning in light and dark.
void ConsolePage::recolour() {
  for (QTextBlock block = text_->document()->begin(); block.isValid(); block = block.next()) {
    if (block.userState() < 0) continue;
    QTextCursor cursor(block);
    cursor.select(QTextCursor::BlockUnderCursor);
    cursor.setCharFormat(format_of(static_cast<Voice>(block.userState())));
  }
}

void ConsolePage::send(const QString& line) {
  history_.removeAll(line);
  history_ << line;
  while (history_.size() > kHistory) history_.removeFirst();
  recalled_ = -1;
  append(QStringLiteral("> ") + line, Voice::kUser);
  desk_.session.console(line, [self = QPointer<ConsolePage>(this)](const joblink::Reply& reply) {
    if (self.isNull()) return;
    if (reply.has_error())
      self->append(to_words(reply.error()), Voice::kRefusal);
    else
      self->append(reply.console().text().empty() ? QStringLiteral("ok")
                                                  : QString::fromStdString(reply.console().text()),
                   Voice::kAnswer);
  });
}

void ConsolePage::complete() {
  const QString typed = line_->text();
  if (typed.isEmpty() || typed.contains(QLatin1Char(' '))) {
    completer_->popup()->hide();
    return;
  }
  completer_->setCompletionPrefix(typed);
  if (completer_->completionCount() > 0)
    completer_->complete();
  else
    completer_->popup()->hide();
}

bool ConsolePage::eventFilter(QObject* watched, QEvent* event) {
  if (watched != line_ || event->type() != QEvent::KeyPress || history_.isEmpty())
    return SpeakingWidget::eventFilter(watched, event);
  const int key = static_cast<QKeyEvent*>(event)->key();
  if (key != Qt::Key_Up && key != Qt::Key_Down) return SpeakingWidget::eventFilter(watched, event);
  const int newest = static_cast<int>(history_.size()) - 1;
  if (key == Qt::Key_Up) {
    if (recalled_ < 0) draft_ = line_->text();
    recalled_ = recalled_ < 0 ? newest : std::max(0, recalled_ - 1);
  } else {
    if (recalled_ < 0) return true;
    recalled_ = recalled_ >= newest ? -1 : recalled_ + 1;
  }
  line_->setText(recalled_ < 0 ? draft_ : history_[recalled_]);
  return true;
}

}  // namespace kinebus::gui
