#ifndef RUGO_JOBS_CONTACT_CONTACT_VIEW_H
#define RUGO_JOBS_CONTACT_CONTACT_VIEW_H

struct result_view;
extern const struct result_view CONTACT_VIEW; /* schema/result/view.h */

#endif
