#include "host.h"
gboolean rp_host_dialog(rp_host *host, rp_settings *settings, rp_picture *picture,
                        rp_request *request) {
  (void)host;
  (void)settings;
  (void)picture;
  (void)request;
  return FALSE;
}
