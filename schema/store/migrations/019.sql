-- The jobs of a study that run, which its status asks for, without a walk over all that it ever had.
CREATE INDEX job_running ON job(study_id, case_number) WHERE state = 'running';
