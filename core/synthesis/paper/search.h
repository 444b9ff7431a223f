/* The search phase: for each output neighbourhood x_p a near z_p of the exemplar. */
#ifndef RECEDE_SYNTHESIS_PAPER_SEARCH_H
#define RECEDE_SYNTHESIS_PAPER_SEARCH_H

#include "synthesis/paper/cluster_tree.h"
#include "synthesis/paper/matches.h"
#include "synthesis/paper/settings.h"
#include "synthesis/paper/space.h"

typedef struct rc_paper_search {
  const rc_paper_settings *settings;
  const rc_paper_level *level;
  rc_windows windows;
  rc_space space;
  rc_corner *members; /* of the tree */
  float *vectors;     /* members x dims; NULL: read from the picture */
  rc_tree tree;
  float least_distance; /* floor of ||x_p - z_p||^2 in eq. 7 */
  float *scratch;       /* threads x scratch_size */
  size_t scratch_size;
  rc_corner *snapshot; /* the matches before the search */
} rc_paper_search;

/* Finds the windows of that width; windows.count == 0 when there are none. */
recede_status rc_paper_search_prepare(rc_context *context, const rc_paper_settings *settings,
                                      const rc_paper_level *level, int width, uint64_t key,
                                      rc_paper_search *search);
/* Fills distance from the matches as they are. */
recede_status rc_paper_search_measure(rc_context *context, rc_paper_search *search,
                                      rc_matches *matches);
/* The nearest of the tree's answer, the match so far and, with coherence, the neighbours' matches
 * shifted. *changed counts the matches that are new. */
recede_status rc_paper_search_run(rc_context *context, rc_paper_search *search, rc_matches *matches,
                                  int *changed);

#endif
