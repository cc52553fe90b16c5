-- The jobs of a study that run, which its status asks for, without a walk over all that it ever had.
CREATE INDEX job_running ON job(study_id, case_number) WHERE state = 'running';
-- The queue, which whoever asks for a position reads as a whole, without the rows of its studies. Nothing of it changes
-- while they wait. Of those that run, study_line says which they are.
CREATE INDEX study_queued ON study(owner, priority DESC, id, state, realisations_done, seconds, realisations_waiting, work, jobs, jobs_waiting)
    WHERE state = 'queued';
DROP INDEX study_line;
CREATE INDEX study_line ON study(owner, priority DESC, id, state) WHERE state IN ('queued', 'running');
