#include "tests/studies/figures/measures.hpp"

namespace sage::figures {

namespace {

constexpr Word kWords[] = {
    {"identical", "differences up to 1e-6",
     "linear elasticity makes these equalities exact; what is left is rounding and the solver"},
    {"approximately N", "0.9 N to 1.1 N",
     "one tenth of the number: the chapter rounds 24.03 to 25 and 11.89 to 12"},
    {"approximately half", "0.4 to 0.6", "a fraction in words is less sharp than a number: one fifth of it"},
    {"more than half", "less than 0.5 is left", "the sentence's own number"},
    {"much less", "at most one third", "less than 'approximately half' by a clear step"},
    {"much less than 1 percent", "at most 0.33 percent", "'much less' of 1 percent"},
    {"negligible (measured stress)", "at most 0.5 percent",
     "smaller than the least increase that the chapter calls an effect (0.6 percent, Table 7.3) and than "
     "a line's width in its figures"},
    {"negligible (stress in the specimen)", "at most 3.3 percent",
     "the chapter calls 'approximately only 3 percent' negligible; 'approximately' adds a tenth"},
    {"affected", "changed by more than 5 percent of the correct deviator stress",
     "half a contour interval where ten contours span that stress: what an eye sees in a contour plot"},
    {"unaffected", "changed by at most 5 percent of the correct deviator stress", "not 'affected'"},
    {"greater everywhere", "nowhere smaller by more than 0.5 percent of the correct deviator stress",
     "a tenth of what is seen in a contour plot"},
    {"zero (shear stress)", "at most 1 percent of the correct deviator stress",
     "a computed stress is never zero; a fifth of what is seen"},
    {"small region", "at most 15 percent of the section",
     "one limit for the two phrases; 15 percent is the chapter's own number for the parts at the ends that do "
     "not yield"},
    {"significant portion", "at least 15 percent of the section", "not a 'small region'"},
    {"most", "at least two thirds", "clearly more than half"},
    {"entire, all", "at least 99 percent", "a point or two at a singular corner are not 'all'"},
    {"dramatically", "by at least half of the correct deviator stress",
     "a change of the order of the load itself"},
    {"significantly",
     "by at least 10 percent of itself (of the correct deviator stress where the correct value is 0)",
     "twice what is seen"},
    {"increases, varies", "by at least 10 percent of itself", "outside 'approximately'"},
    {"more so", "by at least 5 percent", "two means over the section hardly differ by chance of the mesh"},
    {"at a point", "within 0.15 R along r and z", "two elements of the coarser mesh"},
    {"near", "in the outer (inner) quarter", "the next half is 'halfway'"},
    {"near the axis (centre of a region)", "centre within 0.4 R",
     "a region that starts at the axis and is no wider than 0.8 R"},
    {"halfway", "0.35 to 0.65", "the middle third, rounded"},
    {"pattern the same", "correlation at least 0.98",
     "4 percent of the variance differ: not seen beside each other"},
    {"pattern similar", "correlation at least 0.8", "most (64 percent) of the variance is the same"},
    {"some change in the pattern", "correlation at most 0.98", "no longer 'the same'"},
    {"significant change in the pattern", "correlation at most 0.5", "most of the variance differs"},
    {"not near failure", "stress level at most 0.75", "a quarter of the strength is left"},
    {"has not failed", "stress level below 0.999", "1, less what Newton's iteration leaves"},
    {"less, more than correct", "by at least 0.0005 of it", "half of the last digit of Table 7.4"},
    {"not linear", "the curve leaves its chord by at least 10 percent", "outside 'approximately'"},
    {"some local yielding", "1 percent to half of the section", "more than elements at a corner, and not most"},
    {"progresses, expands", "by at least 0.01 of R, H or the section", "more than elements at a corner"},
    {"decreasing", "mean stress level lower by at least 0.05", "as 'affected'"},
    {"no appreciable change", "mean stress level changes by at most 0.01", "less than a contour plot shows"},
};

}  // namespace

std::span<const Word> words() {
  return kWords;
}

}  // namespace sage::figures
