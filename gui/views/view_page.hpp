#pragma once
// The main view: the scene with its tools, the layer slider, and what the colours mean.

#include <QComboBox>
#include <QLabel>
#include <QProgressBar>
#include <QSettings>
#include <QSize>
#include <QSlider>
#include <QToolButton>
#include <QWidget>
#include <string>
#include <vector>

#include "gui/models/print_on_table.hpp"
#include "gui/views/desk.hpp"
#include "gui/views/ramp_legend.hpp"
#include "gui/views/scene_view.hpp"
#include "gui/views/widgets.hpp"

namespace kinebus::gui {

class ViewPage : public SpeakingWidget {
  Q_OBJECT
 public:
  explicit ViewPage(Desk& desk, QWidget* parent = nullptr);
  SceneView& scene() { return *scene_; }
  /// Shows the place of a line of the job.
  void show_line(std::uint32_t line);
  void set_colouring(PathColouring colouring);
  void save(QSettings& settings) const;
  void restore(QSettings& settings);

 private:
  QWidget* make_tools();
  QWidget* make_bottom();
  void take_status();
  void take_path();
  void take_theme();
  void tell_legend();
  void tell_job();
  void tell_layer();
  void tell_trail();
  /// Layers and moves as the sliders say.
  void take_sliders();
  /// The moves of the topmost layer shown, all of them.
  void take_top_layer();

  static std::vector<RampLegend::Kind> kinds_of(const ToolPath& path);

  Desk& desk_;
  SceneView* scene_;
  QSlider *layers_, *first_layer_, *moves_;
  QLabel* layer_text_;
  QComboBox* colouring_;
  RampLegend* legend_;
  ElidedLabel* job_text_;
  QProgressBar* loading_;
  QLabel* broken_;
  QToolButton *machine_, *reach_, *travel_, *remaining_, *trail_;
  std::shared_ptr<const ScenePath> shown_;
  PrintOnTable printed_;
  std::string seen_status_;  ///< what the newest picture was made of
  std::uint32_t wanted_line_ = 0;
  bool fitted_ = false;
};

}  // namespace kinebus::gui
