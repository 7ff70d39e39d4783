#pragma once
// The machine file: read from the gateway, edited, checked there while typing, and saved only when it is
// right.

#include <QLabel>
#include <QListView>
#include <QPushButton>
#include <QSyntaxHighlighter>
#include <QTextDocument>
#include <QTimer>
#include <QWidget>

#include "gui/models/problems_model.hpp"
#include "gui/views/desk.hpp"
#include "gui/views/line_view.hpp"
#include "gui/views/widgets.hpp"

class QTableView;

namespace kinebus::gui {

class TomlHighlighter : public QSyntaxHighlighter {
  Q_OBJECT
 public:
  TomlHighlighter(QTextDocument* document, const Theme& theme);

 protected:
  void highlightBlock(const QString& text) override;

 private:
  const Theme& theme_;
};

class MachineFileEditor : public SpeakingWidget {
  Q_OBJECT
 public:
  explicit MachineFileEditor(Desk& desk, QWidget* parent = nullptr);
  void read_if_empty();
  void read();
  NumberedText& text() { return *text_; }
  int problems() const { return problems_.rowCount(); }

 private:
  enum class Said { kNothing, kSaved, kRestarts };
  void say(Said said, const joblink::Problem& refusal = {});
  void check();
  void save();
  void tell();
  /// Reads again; first asks when that would lose what was typed.
  void ask_to_read();
  void restart();
  void look_at_file();

  Desk& desk_;
  NumberedText* text_;
  ProblemsModel problems_;
  QTableView* table_;
  QPushButton *read_, *save_, *undo_, *restart_;
  ElidedLabel* place_;
  QLabel* verdict_;
  QTimer check_soon_;
  joblink::MachineFile file_;
  bool read_once_ = false, checked_ = false, checking_ = false;
  QString seen_, checked_text_;
  Said said_ = Said::kNothing;
  joblink::Problem refusal_;  ///< of the last save or restart; without words: none
};

}  // namespace kinebus::gui
