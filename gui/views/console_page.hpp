#pragma once
// Lines to the gateway and its answers, with history (arrow keys) and completion.

#include <QCompleter>
#include <QEvent>
#include <QLineEdit>
#include <QPlainTextEdit>
#include <QPushButton>
#include <QStringList>
#include <QTextCharFormat>
#include <QWidget>

#include "gui/views/desk.hpp"
#include "gui/views/widgets.hpp"

namespace kinebus::gui {

class ConsolePage : public SpeakingWidget {
  Q_OBJECT
 public:
  explicit ConsolePage(Desk& desk, QWidget* parent = nullptr);
  void send(const QString& line);
  const QStringList& history() const { return history_; }
  void set_history(const QStringList& lines) { history_ = lines; }

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  enum class Voice { kUser, kAnswer, kRefusal, kMessage };
  void append(const QString& text, Voice voice);
  QTextCharFormat format_of(Voice voice) const;
  void recolour();
  void complete();

  Desk& desk_;
  QPlainTextEdit* text_;
  QLineEdit* line_;
  QPushButton* send_;
  QCompleter* completer_;
  QStringList history_;  ///< oldest first
  int recalled_ = -1;
  QString draft_;
};

}  // namespace kinebus::gui
