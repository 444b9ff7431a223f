/* Several starts of the coarsest level, of which the best is kept: chance decides there how stones
 * lie and where joints end, and no finer level can mend it. */
#ifndef RECEDE_SYNTHESIS_SEARCH_TRIAL_H
#define RECEDE_SYNTHESIS_SEARCH_TRIAL_H

#include "synthesis/search/iterate.h"

/* What a start leaves in a level, target pixel by target pixel. */
typedef struct rc_trial {
  rc_copy *field;
  float *cost;
  uint32_t *guide;
} rc_trial;

recede_status rc_trial_new(rc_context *context, const rc_level *level, rc_trial *trial);
void rc_trial_save(const rc_level *level, rc_trial *trial);
void rc_trial_restore(rc_level *level, const rc_trial *trial);
/* A level that is tried apart from the one it is like, and scratch of its own. */
typedef struct rc_lane {
  rc_level level;
  rc_workspace scratch;
} rc_lane;

/* At the most, with what is allocated in them. */
#define RC_MOST_BYTES_OF_LANES ((size_t)12 << 20)
/* In how many lanes so many trials can be run beside each other, and these; one alone is the level
 * itself. */
recede_status rc_lanes_new(rc_context *context, const rc_level *level, const rc_workspace *scratch,
                           int trials, rc_lane **lanes, int *count);
/* How many starts of so many are worth their time in this level. */
int rc_trials_worth(const rc_level *level, int most);
/* What is wrong with the level's guide, in variances; less is better. */
double rc_misfit(const rc_level *level);

#endif
