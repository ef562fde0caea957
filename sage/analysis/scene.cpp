#include "sage/analysis/scene.hpp"

namespace sage {

namespace {

template <class Question>
bool ask(const LawRef& law, Question question) {
  return std::visit([&](const auto* l) { return question(*l); }, law);
}

}  // namespace

Scene analyse_scene(const Model& model) {
  Scene scene;
  scene.dofs = model.dofs();
  for (const Group& group : model.groups) {
    const LawRef law = model.material_of(group).law_ref();
    const bool linear = ask(law, [](const auto& l) { return l.linear(); });
    const bool symmetric = ask(law, [](const auto& l) { return l.symmetric(); });
    scene.group_linear.push_back(linear ? 1 : 0);
    scene.linear = scene.linear && linear;
    scene.symmetric = scene.symmetric && symmetric;
    scene.elements += group.elements();
    scene.points += group.elements() * group.element->traits().points;
  }
  return scene;
}

std::string describe(const Scene& scene) {
  std::string text = scene.linear ? "linear" : "nonlinear";
  text += scene.symmetric ? ", symmetric" : ", unsymmetric";
  return text;
}

}  // namespace sage
