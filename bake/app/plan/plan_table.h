#pragma once
#include "plan/plan_report.h"

namespace galactic::bake {

/// What was made, what lacks, and warnings, for people.
void printPlanTable(const PlanSummary& summary);

}  // namespace galactic::bake
