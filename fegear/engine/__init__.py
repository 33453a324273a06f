"""From what a case asks for to tasks, each computed once: plan, run, executors."""
