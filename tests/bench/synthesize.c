/* One synthesis without a command round it, for the benchmarks and for callgrind:
 *
 *     synthesize WIDTH HEIGHT SIZE OUT KEY=VALUE... < exemplar.rgb > line.json
 *
 * The exemplar is WIDTH x HEIGHT x 3 bytes; the result, SIZE x SIZE x 3 bytes, goes to OUT. Prints
 * CPU seconds, the energy of the report and the iterations. One thread. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "recede.h"

static double cpu_seconds(void) {
  struct timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static int set_params(recede_params *params, int count, char **settings) {
  char message[300];
  recede_params_init(params);
  params->orientation = RECEDE_ORIENTATION_ANGLES;
  for (int i = 0; i < count; i++) {
    char *value = strchr(settings[i], '=');
    if (value) *value++ = '\0';
    if (value &&
        recede_params_set(params, settings[i], value, message, sizeof message) == RECEDE_OK)
      continue;
    fprintf(stderr, "synthesize: %s\n", value ? message : "settings are KEY=VALUE");
    return 0;
  }
  return 1;
}

static int run(const recede_view *exemplar, const recede_params *params, recede_view *result) {
  recede_host host;
  recede_host_init(&host);
  host.threads = 1;
  recede_job *job = recede_job_new(&host);
  if (!job) return 0;
  recede_job_set_image(job, exemplar);
  recede_job_set_params(job, params);
  double start = cpu_seconds();
  recede_status status = recede_job_synthesize(job, result);
  double seconds = cpu_seconds() - start;
  const recede_report *report = recede_job_report(job);
  if (status == RECEDE_OK)
    printf("{\"cpu_seconds\": %.4f, \"energy\": %.6g, \"iterations\": %d}\n", seconds,
           report->energy, report->iterations);
  else
    fprintf(stderr, "synthesize: %s\n", recede_job_message(job));
  recede_job_free(&job);
  return status == RECEDE_OK;
}

int main(int count, char **words) {
  recede_params params;
  if (count < 5 || !set_params(&params, count - 5, words + 5)) return 2;
  int width = atoi(words[1]), height = atoi(words[2]), size = atoi(words[3]);
  if (width < 1 || height < 1 || size < 1 || width > 4096 || height > 4096 || size > 4096) return 2;
  size_t read = (size_t)width * (size_t)height * 3, made = (size_t)size * (size_t)size * 3;
  recede_view exemplar = {malloc(read), (size_t)width * 3, width, height, 3, RECEDE_U8};
  recede_view result = {malloc(made), (size_t)size * 3, size, size, 3, RECEDE_U8};
  FILE *out = fopen(words[4], "wb");
  int done = exemplar.data && result.data && out && fread(exemplar.data, 1, read, stdin) == read &&
             run(&exemplar, &params, &result) && fwrite(result.data, 1, made, out) == made;
  done &= !out || fclose(out) == 0;
  free(exemplar.data);
  free(result.data);
  return done ? 0 : 1;
}
