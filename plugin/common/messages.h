/* messages.h - what the user reads, in the user's language. */
#ifndef RP_MESSAGES_H
#define RP_MESSAGES_H

#include <glib.h>

#include "worker.h"

/* What a host found out about the layer that is to be filled. */
typedef struct {
  gboolean elsewhere; /* of another image than the one given */
  gboolean group, indexed, locked, text, floating;
  gboolean filtered; /* it shows other pixels than it has */
  gboolean is_layer; /* else a channel or a mask */
} rp_target;

/* Why this target cannot be filled and what to do; NULL: it can. */
const char *rp_target_refusal(const rp_target *target, gboolean writes, gboolean new_layer);

const char *rp_layer_gone(void);
const char *rp_no_selection(void);
const char *rp_selection_outside(void);
const char *rp_one_layer_only(void);
const char *rp_no_memory(void);
/* GIMP did not take the fill. */
const char *rp_not_taken(void);

/* What is running. */
const char *rp_title(const rp_request *request);
/* The name of a stage of the core. */
const char *rp_stage_label(const char *stage);
/* Why a run failed and what to do (free it). */
char *rp_failure(const rp_request *request);
/* What the user should know about a run that went well; NULL when nothing (free it). */
char *rp_warning(const rp_request *request);

#endif
