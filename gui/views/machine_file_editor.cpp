#include "gui/views/machine_file_editor.hpp"

#include <QAbstractButton>
#include <QAbstractItemView>
#include <QColor>
#include <QFont>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QItemSelectionModel>
#include <QLabel>
#include <QLatin1Char>
#include <QMessageBox>
#include <QModelIndex>
#include <QPlainTextEdit>
#include <QPointer>
#include <QPushButton>
#include <QRegularExpression>
#include <QSizePolicy>
#include <QSplitter>
#include <QSyntaxHighlighter>
#include <QTableView>
#include <QTextCharFormat>
#include <QTextDocument>
#include <QTimer>
#include <QVBoxLayout>
#include <QVector>
#include <QWidget>
#include "gui/models/format.hpp"

namespace kinebus::gui {
namespace {
constexpr int kCheckAfter_ms = 400;
}

TomlHighlighter::TomlHighlighter(QTextDocument* document, const Theme& theme)
    : QSyntaxHighlighter(document), theme_(theme) {
  connect(&theme, &Theme::changed, this, &QSyntaxHighlighter::rehighlight);
}

void TomlHighlighter::highlightBlock(const QString& text) {
  const ThemeColours& colours = theme_.colours();
  int comment = static_cast<int>(text.size());
  bool quoted = false;
  for (int i = 0; i < text.size(); ++i) {
    if (text[i] == QLatin1Char('"')) quoted = !quoted;
    if (text[i] == QLatin1Char('#') && !quoted) {
      comment = i;
      break;
    }
  }
  static const QRegularExpression table(QStringLiteral(R"(^\s*\[[^\]]*\])")),
      key(QStringLiteral(R"(^\s*([\w.-]+)\s*=)")), text_value(QStringLiteral(R"("[^"]*")")),
      number(QStringLiteral(R"((?<![\w.])[-+]?\d[\d_.eE+-]*|\b(?:true|false)\b)"));
  const auto apply = [&](const QRegularExpression& pattern, const QColor& colour, int group, bool bold) {
    auto matches = pattern.globalMatch(text);
    while (matches.hasNext()) {
      const auto match = matches.next();
      if (match.capturedStart(group) >= comment) continue;
      QTextCharFormat format;
      format.setForeground(colour);
      if (bold) format.setFontWeight(QFont::DemiBold);
      setFormat(static_cast<int>(match.capturedStart(group)), static_cast<int>(match.capturedLength(group)),
                format);
    }
  };
  apply(number, colours.busy, 0, false);
  apply(text_value, colours.good, 0, false);
  apply(key, colours.text, 1, false);
  apply(table, colours.accent, 0, true);
  if (comment < text.size()) setFormat(comment, static_cast<int>(text.size()) - comment, colours.muted);
}

MachineFileEditor::MachineFileEditor(Desk& desk, QWidget* parent)
    : SpeakingWidget(parent), desk_(desk), problems_(this), check_soon_(this) {
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 10, 0, 0);
  column->setSpacing(8);
  place_ = new ElidedLabel(this);
  place_->setProperty("role", "muted");
  place_->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Preferred);
  read_ = make_button(desk_.theme, QStringLiteral("refresh"), "", this);
  undo_ = make_button(desk_.theme, QStringLiteral("turn-left"), "", this);
  save_ = make_button(desk_.theme, QStringLiteral("save"), "primary", this);
  restart_ = make_button(desk_.theme, QStringLiteral("power"), "", this);
  auto* row = new QHBoxLayout;
  row->setSpacing(8);
  row->addWidget(place_, 1);
  row->addWidget(undo_);
  row->addWidget(read_);
  row->addWidget(save_);
  row->addWidget(restart_);
  column->addLayout(row);
  auto* parts = new QSplitter(Qt::Vertical, this);
  text_ = new NumberedText(desk_.theme, parts);
  new TomlHighlighter(text_->document(), desk_.theme);
  auto* below = new QWidget(parts);
  auto* below_column = new QVBoxLayout(below);
  below_column->setContentsMargins(0, 4, 0, 0);
  verdict_ = new QLabel(below);
  wrap_words(*verdict_);
  table_ = new QTableView(below);
  table_->setModel(&problems_);
  table_->setSelectionBehavior(QAbstractItemView::SelectRows);
  table_->setSelectionMode(QAbstractItemView::SingleSelection);
  table_->setShowGrid(false);
  table_->setWordWrap(false);
  table_->setTabKeyNavigation(false);
  table_->verticalHeader()->hide();
  table_->verticalHeader()->setDefaultSectionSize(30);
  table_->horizontalHeader()->setSectionResizeMode(ProblemsModel::kKind, QHeaderView::ResizeToContents);
  table_->horizontalHeader()->setSectionResizeMode(ProblemsModel::kLine, QHeaderView::ResizeToContents);
  table_->horizontalHeader()->setSectionResizeMode(ProblemsModel::kWords, QHeaderView::Stretch);
  table_->horizontalHeader()->setDefaultAlignment(Qt::AlignLeading | Qt::AlignVCenter);
  table_->setMinimumHeight(90);
  below_column->addWidget(verdict_);
  below_column->addWidget(table_, 1);
  parts->addWidget(text_);
  parts->addWidget(below);
  parts->setStretchFactor(0, 4);
  parts->setStretchFactor(1, 1);
  parts->setChildrenCollapsible(false);
  column->addWidget(parts, 1);

  check_soon_.setSingleShot(true);
  check_soon_.setInterval(kCheckAfter_ms);
  connect(&check_soon_, &QTimer::timeout, this, &MachineFileEditor::check);
  connect(text_->document(), &QTextDocument::contentsChanged, this, [this] {
    // Colouring changes the document too, but not its text.
    const QString text = text_->toPlainText();
    if (text == seen_) return;
    seen_ = text;
    say(Said::kNothing);
    check_soon_.start();
    tell();
  });
  const auto go = [this](const QModelIndex& index) {
    if (index.isValid() && problems_.at(index.row()).line > 0)
      text_->go_to(problems_.at(index.row()).line, problems_.at(index.row()).column);
  };
  connect(table_->selectionModel(), &QItemSelectionModel::currentRowChanged, this, go);
  connect(table_, &QTableView::clicked, this, go);
  connect(read_, &QPushButton::clicked, this, &MachineFileEditor::ask_to_read);
  connect(restart_, &QPushButton::clicked, this, &MachineFileEditor::restart);
  connect(undo_, &QPushButton::clicked, text_, &QPlainTextEdit::undo);
  connect(save_, &QPushButton::clicked, this, &MachineFileEditor::save);
  connect(&desk_.session, &Session::link_changed, this, [this] {
    if (desk_.session.link_state() == Session::LinkState::kNone) {
      read_once_ = false;
      text_->clear();
    }
    // It is back, with another file than before.
    if (desk_.session.connected() && said_ == Said::kRestarts) {
      say(Said::kNothing);
      if (!text_->document()->isModified()) read();
    }
    tell();
  });
  says([this] {
    read_->setText(tr("Read again"));
    undo_->setText(tr("Undo"));
    save_->setText(tr("Save on the gateway"));
    restart_->setText(tr("Restart the gateway"));
    restart_->setToolTip(tr("It begins anew with the file as it is saved, and keeps positions"));
    text_->setAccessibleName(tr("Machine file"));
    table_->setAccessibleName(tr("What is wrong in the machine file"));
    emit problems_.headerDataChanged(Qt::Horizontal, 0, ProblemsModel::kColumns - 1);
    tell();
  });
}

void MachineFileEditor::read_if_empty() {
  if (!read_once_ && desk_.session.connected()) read();
}

void MachineFileEditor::read() {
  joblink::ClientMessage request;
  request.mutable_read_machine_file();
  desk_.session.send(std::move(request),
                     [self = QPointer<MachineFileEditor>(this)](const joblink::Reply& reply) {
                       if (self.isNull()) return;
                       if (!reply.has_machine_file()) {
                         self->say(Said::kNothing, reply.error());
                         self->tell();
                         return;
                       }
                       self->read_once_ = true;
                       self->file_ = reply.machine_file();
                       self->text_->setPlainText(QString::fromStdString(self->file_.text()));
                       self->text_->document()->setModified(false);
                       self->check();
                     });
}

void MachineFileEditor::check() {
  if (!desk_.session.connected() || text_->document()->isEmpty() || checking_) return;
  checking_ = true;
  joblink::ClientMessage request;
  request.mutable_check_machine_file()->set_text(seen_.toStdString());
  desk_.session.send(std::move(request),
                     [self = QPointer<MachineFileEditor>(this), text = seen_](const joblink::Reply& reply) {
                       if (self.isNull()) return;
                       self->checking_ = false;
                       self->checked_ = reply.has_machine_file_check();
                       self->checked_text_ = text;
                       if (self->checked_) {
                         self->problems_.set(ProblemsModel::of(reply.machine_file_check()));
                         QVector<int> lines;
                         for (int i = 0; i < self->problems_.rowCount(); ++i)
                           lines << self->problems_.at(i).line;
                         self->text_->mark_lines(lines);
                       }
                       if (self->seen_ != text) self->check_soon_.start();
                       self->tell();
                     });
  tell();
}

void MachineFileEditor::save() {
  joblink::ClientMessage request;
  request.mutable_write_machine_file()->set_text(text_->toPlainText().toStdString());
  request.mutable_write_machine_file()->set_expected_sha256(file_.sha256());
  desk_.session.command(std::move(request),
                        [self = QPointer<MachineFileEditor>(this)](const joblink::Reply& reply) {
                          if (self.isNull()) return;
                          if (reply.has_error()) {
                            self->say(Said::kNothing, reply.error());
                            return self->tell();
                          }
                          self->text_->document()->setModified(false);
                          self->say(Said::kSaved);
                          self->look_at_file();
                        });
}

/// What the gateway says of its file now; the text stays as it is.
void MachineFileEditor::look_at_file() {
  joblink::ClientMessage request;
  request.mutable_read_machine_file();
  desk_.session.send(std::move(request),
                     [self = QPointer<MachineFileEditor>(this)](const joblink::Reply& reply) {
                       if (self.isNull()) return;
                       if (reply.has_machine_file()) self->file_ = reply.machine_file();
                       self->tell();
                     });
}

void MachineFileEditor::ask_to_read() {
  if (!text_->document()->isModified()) return read();
  auto* question =
      new QMessageBox(QMessageBox::Question, tr("Read again"),
                      tr("What you have changed here is not saved. Read the gateway's file over it?"),
                      QMessageBox::NoButton, window());
  question->setAttribute(Qt::WA_DeleteOnClose);
  auto* yes = question->addButton(tr("Read again"), QMessageBox::DestructiveRole);
  auto* no = question->addButton(tr("Keep my changes"), QMessageBox::RejectRole);
  question->setDefaultButton(no);
  question->setEscapeButton(no);
  connect(yes, &QAbstractButton::clicked, this, &MachineFileEditor::read);
  question->open();
}

void MachineFileEditor::restart() {
  desk_.session.restart_gateway([self = QPointer<MachineFileEditor>(this)](const joblink::Reply& reply) {
    if (self.isNull()) return;
    if (reply.has_error())
      self->say(Said::kNothing, reply.error());
    else
      self->say(Said::kRestarts);
    self->tell();
  });
}

void MachineFileEditor::say(Said said, const joblink::Problem& refusal) {
  said_ = said;
  refusal_ = refusal;
}

void MachineFileEditor::tell() {
  const bool connected = desk_.session.connected();
  const bool fresh = checked_ && checked_text_ == seen_;
  read_->setEnabled(connected);
  // A file that is newer than what runs is of no use before.
  restart_->setVisible(connected && read_once_ && file_.restart_needed());
  undo_->setEnabled(text_->document()->isUndoAvailable());
  save_->setEnabled(connected && read_once_ && file_.writable() && fresh && problems_.rowCount() == 0 &&
                    text_->document()->isModified());
  QString place;
  if (!file_.path().empty())
    place = Format::isolated(QString::fromStdString(file_.path()));
  else
    place = read_once_ ? tr("The built-in machine file") : tr("Not read yet");
  if (read_once_ && !file_.writable()) place += QStringLiteral(" · ") + tr("cannot be changed from here");
  if (read_once_ && file_.restart_needed())
    place += QStringLiteral(" · ") + tr("newer than what the gateway runs with");
  place_->set_text(place);
  table_->setVisible(problems_.rowCount() > 0);
  if (!refusal_.rule().empty())
    verdict_->setText(to_words(refusal_));
  else if (said_ == Said::kSaved)
    verdict_->setText(tr("Saved. The gateway uses it from its next start."));
  else if (said_ == Said::kRestarts)
    verdict_->setText(tr("The gateway begins anew."));
  else if (!read_once_)
    verdict_->setText(tr("The machine file says what the machine is: kinematics, axes, limits, nodes."));
  else if (!fresh)
    verdict_->setText(tr("Checking…"));
  else if (problems_.rowCount() == 0)
    verdict_->setText(tr("The file is right."));
  else
    verdict_->setText(tr("%Ln mistake(s): it cannot be saved.", nullptr, problems_.rowCount()));
}

}  // namespace kinebus::gui
