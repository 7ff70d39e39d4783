#include "gui/views/jobs_page.hpp"

#include <QAbstractButton>
#include <QAbstractItemModel>
#include <QAbstractItemView>
#include <QDragEnterEvent>
#include <QDragLeaveEvent>
#include <QDropEvent>
#include <QFileDialog>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QItemSelectionModel>
#include <QMessageBox>
#include <QMimeData>
#include <QModelIndex>
#include <QPointer>
#include <QPushButton>
#include <QSplitter>
#include <QStringList>
#include <QTimer>
#include <QUrl>
#include <QVBoxLayout>
#include <QWidget>

#include "gui/models/format.hpp"
#include "gui/session/job_upload.hpp"
#include "gui/views/job_delegate.hpp"

namespace kinebus::gui {
namespace {

void prepare(QTableView* table) {
  table->setSelectionBehavior(QAbstractItemView::SelectRows);
  table->setSelectionMode(QAbstractItemView::SingleSelection);
  table->setEditTriggers(QAbstractItemView::NoEditTriggers);
  table->setShowGrid(false);
  table->setWordWrap(false);  // a row has one line, cut with dots, whole in its tip
  table->setAlternatingRowColors(true);
  table->setTabKeyNavigation(false);
  table->verticalHeader()->hide();
  table->verticalHeader()->setDefaultSectionSize(34);
  table->horizontalHeader()->setHighlightSections(false);
  table->horizontalHeader()->setDefaultAlignment(Qt::AlignLeading | Qt::AlignVCenter);
}

}  // namespace

JobsPage::JobsPage(Desk& desk, QWidget* parent) : SpeakingWidget(parent), desk_(desk), problems_(this) {
  setAcceptDrops(true);
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(14, 12, 14, 12);
  column->setSpacing(10);
  column->addWidget(make_drop_zone());
  splitter_ = new QSplitter(Qt::Vertical, this);
  splitter_->addWidget(make_table());
  splitter_->addWidget(make_result());
  splitter_->setStretchFactor(0, 3);
  splitter_->setStretchFactor(1, 2);
  splitter_->setChildrenCollapsible(false);
  column->addWidget(splitter_, 1);
  connect(&desk_.session, &Session::jobs_changed, this, &JobsPage::tell_store);
  connect(&desk_.session, &Session::status_changed, this, &JobsPage::take_selection);
  connect(&desk_.session, &Session::link_changed, this, &JobsPage::take_selection);
  connect(&desk_.record, &JobRecord::checked, this, &JobsPage::take_start);
  connect(&desk_.record, &JobRecord::ended, this, [this] {
    if (desk_.record.end() == JobRecord::End::kRefused) take_start();
  });
  take_selection();
}

QWidget* JobsPage::make_drop_zone() {
  drop_zone_ = new QWidget(this);
  drop_zone_->setObjectName(QStringLiteral("dropZone"));
  drop_zone_->setAttribute(Qt::WA_StyledBackground);
  auto* row = new QHBoxLayout(drop_zone_);
  row->setContentsMargins(18, 13, 14, 13);
  row->setSpacing(14);
  auto* words = new ElidedLabel(drop_zone_);
  words->setProperty("role", "muted");
  auto* choose = make_button(desk_.theme, QStringLiteral("upload"), "", drop_zone_);
  store_text_ = make_label("small", drop_zone_);
  row->addWidget(words, 1);
  row->addWidget(store_text_);
  row->addWidget(choose);
  connect(choose, &QPushButton::clicked, this, &JobsPage::choose_file);
  says([this, words, choose] {
    words->set_text(tr("Drop G-code files here to send them to the gateway"));
    choose->setText(tr("Choose a file…"));
    tell_store();
  });
  return drop_zone_;
}

QWidget* JobsPage::make_table() {
  auto* box = new QWidget(this);
  auto* column = new QVBoxLayout(box);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(9);
  table_ = new QTableView(box);
  prepare(table_);
  table_->setModel(&desk_.jobs);
  table_->setItemDelegate(new JobDelegate(desk_.theme, table_));
  table_->setMinimumHeight(120);
  QHeaderView* header = table_->horizontalHeader();
  header->setSectionResizeMode(JobsModel::kName, QHeaderView::Stretch);
  for (int c = 1; c < JobsModel::kColumns; ++c)
    header->setSectionResizeMode(c, QHeaderView::ResizeToContents);
  header->setMinimumSectionSize(70);
  column->addWidget(table_, 1);

  auto* row = new QHBoxLayout;
  row->setSpacing(8);
  start_ = make_button(desk_.theme, QStringLiteral("play"), "primary", box);
  check_ = make_button(desk_.theme, QStringLiteral("check"), "", box);
  show_ = make_button(desk_.theme, QStringLiteral("view"), "", box);
  delete_ = make_button(desk_.theme, QStringLiteral("trash"), "danger", box);
  for (QPushButton* button : {start_, check_, show_}) row->addWidget(button);
  row->addStretch(1);
  row->addWidget(delete_);
  column->addLayout(row);

  connect(start_, &QPushButton::clicked, this, [this] {
    if (const QString job = selected_job(); !job.isEmpty()) {
      desk_.session.start_job(job);
      desk_.path.show_job(job);
      emit show_view();
    }
  });
  connect(check_, &QPushButton::clicked, this, &JobsPage::check);
  connect(show_, &QPushButton::clicked, this, [this] {
    desk_.path.show_job(selected_job());
    emit show_view();
  });
  connect(delete_, &QPushButton::clicked, this, [this] {
    const int row_now = table_->currentIndex().row();
    if (JobUpload* upload = desk_.jobs.upload_at(row_now))
      upload->stop();
    else
      ask_to_delete();
  });
  connect(table_, &QTableView::doubleClicked, show_, &QPushButton::click);
  connect(table_->selectionModel(), &QItemSelectionModel::currentRowChanged, this, &JobsPage::take_selection);
  // A new list keeps the selection by name.
  connect(&desk_.jobs, &QAbstractItemModel::modelAboutToBeReset, this,
          [this] { setProperty("selected", selected_job()); });
  connect(&desk_.jobs, &QAbstractItemModel::modelReset, this,
          [this] { select(property("selected").toString()); });
  says([this] {
    start_->setText(tr("Start"));
    check_->setText(tr("Check"));
    show_->setText(tr("Show"));
    delete_->setText(tr("Delete"));
    table_->setAccessibleName(tr("Jobs on the gateway"));
    desk_.jobs.retranslate();
  });
  return box;
}

QWidget* JobsPage::make_result() {
  auto* card = new Card(this);
  auto* head = new QHBoxLayout;
  result_heading_ = make_label("heading", card);
  result_text_ = make_label("muted", card);
  wrap_words(*result_text_);
  head->addWidget(result_heading_);
  head->addSpacing(10);
  head->addWidget(result_text_, 1);
  card->column()->addLayout(head);
  auto* parts = new QSplitter(Qt::Horizontal, card);
  problems_table_ = new QTableView(parts);
  prepare(problems_table_);
  problems_table_->setModel(&problems_);
  problems_table_->horizontalHeader()->setSectionResizeMode(ProblemsModel::kWords, QHeaderView::Stretch);
  problems_table_->horizontalHeader()->setSectionResizeMode(ProblemsModel::kKind,
                                                            QHeaderView::ResizeToContents);
  problems_table_->horizontalHeader()->setSectionResizeMode(ProblemsModel::kLine,
                                                            QHeaderView::ResizeToContents);
  lines_ = new LineView(desk_.theme, parts);
  parts->addWidget(problems_table_);
  parts->addWidget(lines_);
  parts->setStretchFactor(0, 3);
  parts->setStretchFactor(1, 2);
  parts->setMinimumHeight(96);
  card->column()->addWidget(parts, 1);
  const auto jump = [this](const QModelIndex& index) {
    if (!index.isValid()) return;
    const ShownProblem& problem = problems_.at(index.row());
    if (problem.line == 0) return;
    if (desk_.path.name() != shown_job_ || desk_.path.file_path().isEmpty()) desk_.path.show_job(shown_job_);
    if (!desk_.path.file_path().isEmpty())
      lines_->show_line(desk_.path.file_path(), problem.line, problem.column);
    emit show_place(static_cast<std::uint32_t>(problem.line));
  };
  connect(problems_table_->selectionModel(), &QItemSelectionModel::currentRowChanged, this, jump);
  connect(problems_table_, &QTableView::doubleClicked, this, [this](const QModelIndex& index) {
    if (problems_.at(index.row()).line > 0) emit show_view();
  });
  says([this] {
    result_heading_->setText(tr("Check"));
    problems_table_->setAccessibleName(tr("What the check has found"));
    lines_->setAccessibleName(tr("Lines of the job"));
    lines_->setPlaceholderText(tr("Choose a finding: its line is shown here, its place in the scene."));
    take_selection();
  });
  return card;
}

QString JobsPage::selected_job() const {
  const joblink::Job* job = desk_.jobs.job_at(table_->currentIndex().row());
  return job == nullptr ? QString() : QString::fromStdString(job->name());
}

void JobsPage::select(const QString& job_name) {
  const int row = desk_.jobs.row_of(job_name);
  if (row >= 0) table_->setCurrentIndex(desk_.jobs.index(row, 0));
}

void JobsPage::take_selection() {
  const bool connected = desk_.session.connected();
  const QString job = selected_job();
  const bool upload = desk_.jobs.upload_at(table_->currentIndex().row()) != nullptr;
  const bool chosen = connected && !job.isEmpty();
  const joblink::Status& status = desk_.session.status();
  // An interrupted job is resumed or cancelled first: starting another one would drop it.
  set_usable(*start_, chosen && desk_.session.allowed(joblink::COMMAND_START_JOB) && !status.interrupted(),
             desk_.session.why_not(joblink::COMMAND_START_JOB));
  check_->setEnabled(chosen && !checking_);
  show_->setEnabled(chosen);
  delete_->setEnabled((chosen && desk_.session.status().job() != job.toStdString()) || upload);
  if (job != shown_job_) show_result();
  const joblink::Job* stored = desk_.jobs.find(job);
  const auto found = results_.constFind(job);
  // A check of before this program was begun has left its sum alone.
  const joblink::PreflightSummary* summary =
      found != results_.cend() && found->checked                                 ? &found->summary
      : stored != nullptr && stored->has_preflight() && found == results_.cend() ? &stored->preflight()
                                                                                 : nullptr;
  if (checking_ && job == checked_job_) {
    result_text_->setText(tr("Checking %1…").arg(Format::isolated(checked_job_)));
  } else if (summary != nullptr) {
    const QString time = Format::duration(summary->motion_s() + summary->dwell_s());
    result_text_->setText(summary->errors() > 0 ? tr("%1: %Ln error(s). It will not start.", nullptr,
                                                     static_cast<int>(summary->errors()))
                                                      .arg(Format::isolated(job))
                          : summary->warnings() > 0
                              ? tr("%1: it can be printed, with %Ln warning(s). It takes %2.", nullptr,
                                   static_cast<int>(summary->warnings()))
                                    .arg(Format::isolated(job), time)
                              : tr("%1: nothing is wrong. It takes %2.").arg(Format::isolated(job), time));
  } else {
    result_text_->setText(tr("The gateway checks a whole job against every limit before anything moves."));
  }
}

/// Of the job that is selected.
void JobsPage::show_result() {
  shown_job_ = selected_job();
  const joblink::Job* job = desk_.jobs.find(shown_job_);
  // Another text under the same name was never checked.
  if (const auto found = results_.constFind(shown_job_);
      found != results_.cend() && (job == nullptr || job->hash() != found->hash))
    results_.remove(shown_job_);
  problems_.set(results_.value(shown_job_).problems);
  lines_->show_nothing();
}

void JobsPage::check() {
  const QString job = selected_job();
  if (job.isEmpty()) return;
  checking_ = true;
  checked_job_ = job;
  results_.remove(job);
  show_result();
  desk_.session.check_job(job, [self = QPointer<JobsPage>(this), job](const joblink::Reply& reply) {
    if (!self.isNull()) self->take_result(job, reply);
  });
  take_selection();
}

void JobsPage::take_result(const QString& name, const joblink::Reply& reply) {
  if (name != checked_job_) return;
  checking_ = false;
  const joblink::Job* job = desk_.jobs.find(name);
  Result result{.hash = job != nullptr ? job->hash() : std::string(),
                .problems = {},
                .summary = reply.preflight().summary(),
                .checked = reply.has_preflight()};
  if (result.checked)
    result.problems = ProblemsModel::of(reply.preflight());
  else
    result.problems = {{true, static_cast<int>(reply.error().line()), 0, reply.error()}};
  const bool checked = result.checked;
  results_[name] = std::move(result);
  if (checked) {
    desk_.path.show_job(name);
    desk_.session.list_jobs();
  }
  if (name == selected_job()) {
    show_result();
    if (checked && problems_.rowCount() > 0 && problems_.at(0).line > 0)
      QTimer::singleShot(0, this, [this] {
        if (problems_.rowCount() > 0) problems_table_->setCurrentIndex(problems_.index(0, 0));
      });
  }
  take_selection();
}

void JobsPage::take_start() {
  const JobRecord& record = desk_.record;
  if (record.problems().isEmpty()) return;
  const QString name = QString::fromStdString(record.name());
  const joblink::Job* job = desk_.jobs.find(name);
  Result result{.hash = job != nullptr ? job->hash() : std::string(),
                .problems = record.problems(),
                .summary = {},
                .checked = true};
  for (const ShownProblem& problem : record.problems())
    problem.error ? result.summary.set_errors(result.summary.errors() + 1)
                  : result.summary.set_warnings(result.summary.warnings() + 1);
  const auto known = results_.constFind(name);
  // The check by itself tells more: time, and how much there is beyond what events say.
  if (result.summary.errors() == 0 && known != results_.cend() && known->checked) return;
  if (job != nullptr && job->has_preflight()) {
    result.summary.set_motion_s(job->preflight().motion_s());
    result.summary.set_dwell_s(job->preflight().dwell_s());
  }
  results_[name] = std::move(result);
  shown_job_.clear();
  select(name);
  take_selection();
}

void JobsPage::tell_store() {
  const auto& jobs = desk_.session.jobs();
  store_text_->setText(
      jobs.quota_bytes() > 0
          ? tr("%1 of %2 used")
                .arg(Format::isolated(Format::bytes(static_cast<double>(jobs.used_bytes()))),
                     Format::isolated(Format::bytes(static_cast<double>(jobs.quota_bytes()))))
          : QString());
  if (table_ != nullptr && selected_job().isEmpty() && desk_.jobs.rowCount() > 0)
    table_->setCurrentIndex(desk_.jobs.index(0, 0));
}

void JobsPage::choose_file() {
  auto* dialog = new QFileDialog(window(), tr("Send G-code to the gateway"));
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setFileMode(QFileDialog::ExistingFiles);
  dialog->setNameFilters({tr("G-code (*.gcode *.ngc *.nc *.g *.gco)"), tr("All files (*)")});
  connect(dialog, &QFileDialog::filesSelected, this, &JobsPage::upload);
  dialog->open();
}

void JobsPage::upload(const QStringList& paths) {
  for (const QString& path : paths) desk_.session.upload(path);
}

void JobsPage::ask_to_delete() {
  const QString job = selected_job();
  if (job.isEmpty()) return;
  auto* question = new QMessageBox(QMessageBox::Question, tr("Delete"),
                                   tr("Delete %1 from the gateway?").arg(Format::isolated(job)),
                                   QMessageBox::NoButton, window());
  question->setAttribute(Qt::WA_DeleteOnClose);
  auto* yes = question->addButton(tr("Delete"), QMessageBox::DestructiveRole);
  auto* no = question->addButton(tr("Keep"), QMessageBox::RejectRole);
  question->setDefaultButton(no);
  question->setEscapeButton(no);
  connect(yes, &QAbstractButton::clicked, &desk_.session, [this, job] { desk_.session.delete_job(job); });
  question->open();
}

void JobsPage::dragEnterEvent(QDragEnterEvent* event) {
  if (!event->mimeData()->hasUrls() || !desk_.session.connected()) return;
  event->acceptProposedAction();
  set_role(drop_zone_, "over", QStringLiteral("true"));
}

void JobsPage::dragLeaveEvent(QDragLeaveEvent*) {
  set_role(drop_zone_, "over", QStringLiteral("false"));
}

void JobsPage::dropEvent(QDropEvent* event) {
  set_role(drop_zone_, "over", QStringLiteral("false"));
  QStringList paths;
  for (const QUrl& url : event->mimeData()->urls())
    if (url.isLocalFile()) paths << url.toLocalFile();
  upload(paths);
  event->acceptProposedAction();
}

}  // namespace kinebus::gui
