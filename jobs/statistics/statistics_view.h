#ifndef RUGO_JOBS_STATISTICS_STATISTICS_VIEW_H
#define RUGO_JOBS_STATISTICS_STATISTICS_VIEW_H

struct result_view;
extern const struct result_view STATISTICS_VIEW; /* schema/result/view.h */

#endif
